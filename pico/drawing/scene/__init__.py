"""A bench as data for who draws it elsewhere: the scene as a whole, and what moved of it since."""
