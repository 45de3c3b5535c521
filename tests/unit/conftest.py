"""One thread of PyTorch's: on two cores two processes of two wait for each other, 28 s in place of 2."""

import torch

torch.set_num_threads(1)
