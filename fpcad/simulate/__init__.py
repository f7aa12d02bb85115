"""The hand in MuJoCo: does the exported trajectory turn the tool? docs/physics.md."""
