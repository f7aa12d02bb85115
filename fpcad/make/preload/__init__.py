"""Grip preload: the forces that hold the tool, and what to command so that they arise."""
