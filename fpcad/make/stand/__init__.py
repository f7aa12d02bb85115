"""A bench stand for a hand, and a jig for each pose that holds the tool while the fingers close. docs/assembly.md."""
