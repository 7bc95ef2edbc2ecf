// Incident light at a point, estimated from photons. Functions only.
#ifndef LIB_INCIDENT_GLSL
#define LIB_INCIDENT_GLSL

struct Incident
{
    vec3 irradiance;   // W/m^2
    vec3 direction;    // unit, in which one of its photons travelled, chosen with probability proportional to power
    vec3 in_its_color; // W/m^2: the same luminance in the colour of the light that this photon represents
};

#endif
