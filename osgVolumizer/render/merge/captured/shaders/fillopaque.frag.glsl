// The depth of the opaque scene.

uniform sampler2D opaqueDepth;

void main() { gl_FragDepth = texelFetch(opaqueDepth, ivec2(gl_FragCoord.xy), 0).r; }
