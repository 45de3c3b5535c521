"""One thread of PyTorch's: on two cores two processes of two make a test of 2 s one of 28."""

import torch

torch.set_num_threads(1)
