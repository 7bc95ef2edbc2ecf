// The light that falls on a point, by photons. Functions only.
#ifndef LIB_INCIDENT_GLSL
#define LIB_INCIDENT_GLSL

struct Incident
{
    vec3 irradiance;   // W/m^2
    vec3 direction;    // unit, the way that one of its photons travelled; each stands here as often as it has power
    vec3 in_its_color; // W/m^2: light of the same luminance in the colour of what that photon stands for
};

#endif
