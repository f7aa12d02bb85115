"""The printed parts of a hand, one concept a file."""
