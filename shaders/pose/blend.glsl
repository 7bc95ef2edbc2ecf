// The matrix of a moving vertex. The kernel declares buffers MovingVertices, Influences and Bones before it includes this.
// Functions only.
#ifndef POSE_BLEND_GLSL
#define POSE_BLEND_GLSL

BoneMatrix blendedMatrix(uint vertex)
{
    BoneMatrix m = BoneMatrix(vec4(0.0), vec4(0.0), vec4(0.0));
    for (uint k = moving[vertex].first_influence; k < moving[vertex + 1u].first_influence; ++k)
    {
        float weight = influences[k].weight;
        BoneMatrix bone = bones[influences[k].bone];
        m.x += weight * bone.x;
        m.y += weight * bone.y;
        m.z += weight * bone.z;
    }
    return m;
}

/// Whether it turns surfaces inside out: its determinant is negative.
bool mirrors(BoneMatrix m) { return dot(m.x.xyz, cross(m.y.xyz, m.z.xyz)) < 0.0; }

#endif
