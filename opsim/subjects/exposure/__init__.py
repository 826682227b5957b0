"""What bodies go through: how postures are scored, what is in the hands, and the figures of exposure."""
