"""Tables, pages and pictures of a run."""
