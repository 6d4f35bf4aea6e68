"""Cases: designs of the pivot as TOML files (given data only, each with its source) and what reads them."""
