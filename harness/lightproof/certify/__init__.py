"""The reference engine: proven answers. Imports scenes and geometry, and nothing that estimates."""
