"""Lightproof: is a renderer's light right, and what does it cost?"""
