"""Who solves the chunks: threads and processes of this machine, or a Dask cluster."""
