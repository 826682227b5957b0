"""What the emulator gives on real recordings that it has not seen, beside the paper's scheme and controls."""
