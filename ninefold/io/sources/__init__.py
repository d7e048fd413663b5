"""Sources with geometry: `source` is what every reader returns, `reading` tells formats apart, `samples` come along."""
