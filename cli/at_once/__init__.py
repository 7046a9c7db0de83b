"""What is answered before typer or the library is imported: the top-level help, and Tab."""
