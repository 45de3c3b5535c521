"""Error of a frame from its reference: PSNR, SSIM, FLIP, LPIPS, shadow error [4.1]."""
