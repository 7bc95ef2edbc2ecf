// Geometric variation, the metric of seeding, clustering and interpolation (paper, Eq. 2). Functions only.
#ifndef LIB_VARIATION_GLSL
#define LIB_VARIATION_GLSL

/// sqrt(2 - 2 a.b) of unit vectors: the length of their difference, which rounding leaves 0 for equal ones.
float normalVariation(vec3 a, vec3 b) { return length(a - b); }

/// eps(i, k) = alpha |x_i - x_k| + sqrt(2 - 2 n_i.n_k)
float geometricVariation(float alpha, vec3 x, vec3 n, vec3 center, vec3 normal)
{
    return alpha * length(x - center) + normalVariation(n, normal);
}

#endif
