"""Record: how results are stored, traced to their source, timed, drawn and watched."""
