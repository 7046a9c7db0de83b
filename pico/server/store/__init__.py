"""What the coordinator keeps: tables of SQLite, or of PostgreSQL where several coordinators share them."""
