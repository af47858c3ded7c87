"""Fixtures and the gate for pytest: for this project and for other people's renderers."""
