"""Run: streams a trajectory file to a motor controller and reports how well it was followed."""
