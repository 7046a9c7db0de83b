"""How a journal lies on the disk: its tables, its write-ahead log, and how many changes it has had."""
