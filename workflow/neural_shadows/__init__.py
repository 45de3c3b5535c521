"""Neural Shadow Ray Queries [Spanhoff 2026] as a pipeline, in rooms; each imports those before it.

files         written whole or not at all
running       a job and a run, whatever they make: the call of a stage, log, progress
meshes        a mesh file, made, downloaded or the user's, to a clean mesh in its unit sphere
scenes        what is lit and seen: lights, cameras, tracing
rendering     what a camera sees: G-buffer, exact shadow, shading, viewpoints
shadow_maps   depth seen from the light, and the test against it
denoising     a smooth picture of few shadow rays a pixel
rays          training rays: directions, silhouettes, quadtrees, labels, ray sets on disk
frames        frames for screen-space methods: settings, buffers, exact soft shadows
representations  distance bricks, voxels, heights, coded meshes, and rays that meet them
networks      kinds of networks, trained or not: settings, weight files, quantisation
training      Adam on a network's loss: resumable, reproducible
metrics       PSNR, SSIM, FLIP, LPIPS, shadow error, intervals
evaluation    every method on the same viewpoints: quality, time, memory, cost
reports       tables and figures (a file for each kind), claims, the page
config        the sections of the configuration, a file each
layout        where files lie, which job does which part, what tables and figures are made of
viewer        what leaves for renderers: ONNX and its conventions

A verb is a stage (`rays/sample_rays.py` has the function of the rule `sample_rays`, and is its
script); a noun is what stages are made of.
"""
