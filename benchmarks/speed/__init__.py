"""What fpcad's numerics are measured against, side by side in one run: `make bench`."""
