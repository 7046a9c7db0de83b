"""What a person who steers says to an edge: frames, the dead-man that they hold up, and the steps that they ask for."""
