"""Renderers behind one protocol, each in a process of its own: one adapter a file."""
