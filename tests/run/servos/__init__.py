"""Servos behind a pseudo terminal: what the makers' own SDKs speak to in these tests."""
