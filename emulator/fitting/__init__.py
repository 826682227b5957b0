"""From recordings to an emulator, step by step in ``fit``: preprocessing, registration, steps, noise, report."""
