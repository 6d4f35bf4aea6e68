"""Studies of the pivot: cases, the answers of both models, and the tables and figures drawn from them."""
