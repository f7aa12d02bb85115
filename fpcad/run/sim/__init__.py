"""The simulated controller: a peer that speaks the whole protocol, and joints for it to move."""
