"""Can the hands of a spec's box be made? Corners and random designs, each made and put through the gates."""
