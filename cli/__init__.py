"""The `pico` command: parses, asks `pico.bench.bench` and lets `views` show the answer. It decides nothing itself."""
