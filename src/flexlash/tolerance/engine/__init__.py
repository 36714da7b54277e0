"""The line engine: a model tabulated along lines through the space of its inputs."""
