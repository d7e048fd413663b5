"""Files of relation networks: `network_file` reads and writes them, one module a format (`csp`, `csv_file`, `json_file`)."""
