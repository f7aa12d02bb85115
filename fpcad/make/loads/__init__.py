"""What motors, tendons, bearings, pins and bones of a finished hand must bear. docs/loads.md."""
