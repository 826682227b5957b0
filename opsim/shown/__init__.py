"""What a notebook shows of the main objects: small, escaped HTML without scripts."""
