"""How far a frame is from its reference: PSNR, SSIM, FLIP, LPIPS, shadow error [4.1]."""
