"""The local server, its sockets and pictures, and a browser to try them with."""
