"""Scenario files whose answers theory knows."""
