"""What people and slicers read of a hand: print files, bill, guide, pictures. docs/assembly.md."""
