"""Commands: in each module `main`, a `Command` of parser.py, or in results.py several by their names."""
