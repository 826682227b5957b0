"""Whether the emulator of this checkout gives what that of another gives."""
