"""The verbs of the command line: one short function each, one file a theme."""
