"""The in-house estimators: one method a file."""
