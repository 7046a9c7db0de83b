"""Steps of recipes, a file each; the file's name is the step's."""
