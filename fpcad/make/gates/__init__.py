"""What a part and a hand must pass before they are written: one file a check. docs/checks.md."""
