"""Large data by its content, which stands in no commit and in no journal: a store of objects, and arrays in it."""
