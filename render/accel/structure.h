/* render/accel/structure.h: what Embree has built of a world. */
#ifndef KILN_RENDER_ACCEL_STRUCTURE_H
#define KILN_RENDER_ACCEL_STRUCTURE_H

#include "render/accel/embree.h"

struct accel {
    RTCDevice device;
    RTCScene scene;
    RTCScene *prototypes;
    uint32_t prototype_count;
    long long bytes; /* what Embree says that it allocated */
};

#endif
