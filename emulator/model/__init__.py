"""The joint law of posture, root, pace, duration, marks and bones: how it is held, drawn from, decoded and stored."""
