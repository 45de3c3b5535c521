// Floats' bits in textures: any WebGL2 draws those, floats by an extension.
#define floatsAt(bits, at) uintBitsToFloat(texelFetch(bits, at, 0))
#define bitsOf(x) floatBitsToUint(x)
