"""Walk logs: `json_lines` reads and writes them, `heading_units` doubts headings that look like another unit."""
