#include "tests/importers/subdiv/reference.h"

#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <set>
#include <vector>

namespace {

using namespace OpenSubdiv;

struct Tuple {
    double x[3] = {0, 0, 0};
    void Clear() { x[0] = x[1] = x[2] = 0; }
    void AddWithWeight(const Tuple &t, double w) {
        for (int k = 0; k < 3; k++) x[k] += w * t.x[k];
    }
};
typedef std::vector<Tuple> Tuples;

Tuples load(const float *values, size_t count, int width) {
    Tuples result(count);
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < width; k++) result[i].x[k] = double(values[i * size_t(width) + size_t(k)]);
    return result;
}

Sdc::Options options_of(const kiln_subdivision &r) {
    Sdc::Options o;
    o.SetVtxBoundaryInterpolation(r.boundary == KILN_BOUNDARY_NONE        ? Sdc::Options::VTX_BOUNDARY_NONE
                                  : r.boundary == KILN_BOUNDARY_EDGE_ONLY ? Sdc::Options::VTX_BOUNDARY_EDGE_ONLY
                                                                          : Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    o.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_CORNERS_PLUS1);
    if (r.fvar_boundary == KILN_FVAR_ALL) o.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_ALL);
    if (r.fvar_boundary == KILN_FVAR_NONE) o.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_NONE);
    if (r.fvar_boundary == KILN_FVAR_BOUNDARIES) o.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_BOUNDARIES);
    if (r.fvar_boundary == KILN_FVAR_CORNERS_ONLY) o.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_CORNERS_ONLY);
    if (r.fvar_boundary == KILN_FVAR_CORNERS_PLUS2) o.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_CORNERS_PLUS2);
    o.SetCreasingMethod(r.chaikin_creases ? Sdc::Options::CREASE_CHAIKIN : Sdc::Options::CREASE_UNIFORM);
    o.SetTriangleSubdivision(r.smooth_triangles ? Sdc::Options::TRI_SUB_SMOOTH : Sdc::Options::TRI_SUB_CATMARK);
    return o;
}

std::unique_ptr<Far::TopologyRefiner> create(const kiln_mesh_desc *m, int level) {
    const kiln_subdivision &r = m->subdivision;
    Far::TopologyDescriptor d;
    std::vector<int> triangles(m->face_count, 3);
    d.numVertices = int(m->vertex_count);
    d.numFaces = int(m->face_count);
    d.numVertsPerFace = m->face_sizes ? reinterpret_cast<const int *>(m->face_sizes) : triangles.data();
    d.vertIndicesPerFace = reinterpret_cast<const int *>(m->face_vertices);
    d.numCreases = int(r.crease_count);
    d.creaseVertexIndexPairs = reinterpret_cast<const int *>(r.crease_vertices);
    d.creaseWeights = r.crease_sharpness;
    d.numCorners = int(r.corner_count);
    d.cornerVertexIndices = reinterpret_cast<const int *>(r.corner_vertices);
    d.cornerWeights = r.corner_sharpness;
    d.numHoles = int(r.hole_count);
    d.holeIndices = reinterpret_cast<const int *>(r.holes);
    Far::TopologyDescriptor::FVarChannel uv;
    if (m->primvar_count) {
        uv.numValues = int(m->primvars[0].value_count);
        uv.valueIndices = reinterpret_cast<const int *>(m->primvars[0].indices);
        d.numFVarChannels = 1;
        d.fvarChannels = &uv;
    }
    Sdc::SchemeType scheme = r.scheme == KILN_SCHEME_LOOP       ? Sdc::SCHEME_LOOP
                             : r.scheme == KILN_SCHEME_BILINEAR ? Sdc::SCHEME_BILINEAR
                                                                : Sdc::SCHEME_CATMARK;
    typedef Far::TopologyRefinerFactory<Far::TopologyDescriptor> Factory;
    std::unique_ptr<Far::TopologyRefiner> refiner(Factory::Create(d, Factory::Options(scheme, options_of(r))));
    if (!refiner) return refiner;
    Far::TopologyRefiner::UniformOptions uniform(level);
    uniform.fullTopologyInLastLevel = true;
    refiner->RefineUniform(uniform);
    return refiner;
}

// OpenSubdiv 3.5 reads out of bounds when it is asked for tangents at edges of more than two faces.
bool is_manifold(const Far::TopologyLevel &level) {
    for (int e = 0; e < level.GetNumEdges(); e++)
        if (level.IsEdgeNonManifold(e)) return false;
    for (int v = 0; v < level.GetNumVertices(); v++)
        if (level.IsVertexNonManifold(v)) return false;
    return true;
}

// Where a vertex has sides, or is a corner, OpenSubdiv's tangents are those of one side, or of one face.
bool has_one_normal(const Far::TopologyLevel &level, int vertex) {
    Sdc::Crease::Rule rule = level.GetVertexRule(vertex);
    if (rule == Sdc::Crease::RULE_DART) return true;
    for (int e : level.GetVertexEdges(vertex))
        if (!level.IsEdgeBoundary(e) && level.GetEdgeSharpness(e) > 0) return false;
    return level.GetVertexSharpness(vertex) <= 0 &&
           (rule == Sdc::Crease::RULE_SMOOTH || rule == Sdc::Crease::RULE_CREASE);
}

Tuple normal_of(const Tuple &u, const Tuple &v) {
    Tuple n;
    for (int k = 0; k < 3; k++) n.x[k] = u.x[(k + 1) % 3] * v.x[(k + 2) % 3] - u.x[(k + 2) % 3] * v.x[(k + 1) % 3];
    double length = std::sqrt(n.x[0] * n.x[0] + n.x[1] * n.x[1] + n.x[2] * n.x[2]);
    for (double &x : n.x) x = length > 0 ? x / length : 0;
    return n;
}

float *flatten(const std::vector<const Tuple *> &corners, int width) {
    float *out = static_cast<float *>(std::malloc((corners.size() + 1) * size_t(width) * sizeof(float)));
    for (size_t i = 0; out && i < corners.size(); i++)
        for (int k = 0; k < width; k++) out[i * size_t(width) + size_t(k)] = float(corners[i]->x[k]);
    return out;
}

}  // namespace

bool reference_refine(const kiln_mesh_desc *m, int depth, reference *out) {
    std::unique_ptr<Far::TopologyRefiner> refiner = create(m, depth);
    if (!refiner) return false;
    const Far::TopologyLevel &level = refiner->GetLevel(depth);
    Far::PrimvarRefinerReal<double> primvar(*refiner);
    Tuples points = load(m->positions, m->vertex_count, 3);
    Tuples uvs = m->primvar_count ? load(m->primvars[0].values, m->primvars[0].value_count, 2) : Tuples();
    for (int l = 1; l <= depth; l++) {
        Tuples next(size_t(refiner->GetLevel(l).GetNumVertices()));
        primvar.Interpolate(l, points, next);
        points.swap(next);
        if (uvs.empty()) continue;
        Tuples next_uvs(size_t(refiner->GetLevel(l).GetNumFVarValues()));
        primvar.InterpolateFaceVarying(l, uvs, next_uvs);
        uvs.swap(next_uvs);
    }
    Tuples limit(points.size()), tangent1(points.size()), tangent2(points.size()), limit_uvs(uvs.size());
    if (is_manifold(level)) primvar.Limit(points, limit, tangent1, tangent2);
    else primvar.Limit(points, limit);
    if (!uvs.empty()) primvar.LimitFaceVarying(uvs, limit_uvs);
    Tuples normals(points.size());
    for (size_t v = 0; v < points.size(); v++)
        if (has_one_normal(level, int(v))) normals[v] = normal_of(tangent1[v], tangent2[v]);
    std::vector<const Tuple *> corner_points, corner_normals, corner_uvs;
    for (int f = 0; f < level.GetNumFaces(); f++) {
        if (level.IsFaceHole(f)) continue;
        for (int v : level.GetFaceVertices(f)) {
            corner_points.push_back(&limit[size_t(v)]);
            corner_normals.push_back(&normals[size_t(v)]);
        }
        if (!uvs.empty())
            for (int i : level.GetFaceFVarValues(f)) corner_uvs.push_back(&limit_uvs[size_t(i)]);
    }
    out->corner_count = uint32_t(corner_points.size());
    out->positions = flatten(corner_points, 3);
    out->normals = flatten(corner_normals, 3);
    out->uvs = uvs.empty() ? nullptr : flatten(corner_uvs, 2);
    return true;
}

void reference_free(reference *r) {
    std::free(r->positions);
    std::free(r->normals);
    std::free(r->uvs);
    *r = reference();
}
