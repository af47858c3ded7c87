"""Command line."""


def main() -> int:
    raise NotImplementedError
