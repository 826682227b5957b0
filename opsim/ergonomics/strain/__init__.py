"""Lifting, limits of postures, holds, repetition, energy and the rest they ask for."""
