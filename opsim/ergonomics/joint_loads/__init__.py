"""Torques at joints from posture, body and load, as a share of strength."""
