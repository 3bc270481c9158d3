// importers/subdiv/osd_normals.hpp: analytic normals of the limit surface. Behind osd.h; C++ inside alone.
#ifndef KILN_IMPORTERS_SUBDIV_OSD_NORMALS_HPP
#define KILN_IMPORTERS_SUBDIV_OSD_NORMALS_HPP

#include <opensubdiv/far/topologyRefiner.h>

#include <cstdint>
#include <vector>

namespace kiln_osd {

struct Point {
    float x[3];
    void Clear() { x[0] = x[1] = x[2] = 0; }
    void AddWithWeight(const Point &p, float w) {
        for (int k = 0; k < 3; k++) x[k] += w * p.x[k];
    }
};

struct Normals {
    std::vector<Point> values;          // value v < number of vertices belongs to vertex v; the rest to further sides
    std::vector<uint32_t> corner_values; // by corner of the level, in the order of its faces
};

// For the last level of a refinement, with full topology. control: the refined points, to which limit masks apply;
// limit: their limits.
void limit_normals(const OpenSubdiv::Far::TopologyRefiner &, const Point *control, const Point *limit, Normals &);

}  // namespace kiln_osd

#endif
