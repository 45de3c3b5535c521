"""What is trained: kinds of network, their weight files, and how they are asked [3.3, 3.6]."""
