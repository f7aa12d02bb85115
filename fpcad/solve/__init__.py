"""Layer of fpcad."""
