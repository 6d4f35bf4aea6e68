"""Sweeps: samples of a design space, solved chunk by chunk on all cores or on a cluster, into one table."""
