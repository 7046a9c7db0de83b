"""How results show themselves in a notebook: plain HTML, without a style of its own."""
