"""Human effects on time and quality: frozen models, each off unless a scenario names it; what they do to a floor."""
