#include "importers/subdiv/osd.h"

#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <cstring>
#include <memory>
#include <new>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "importers/subdiv/osd_normals.hpp"

namespace {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;
using kiln_osd::Point;
typedef Far::TopologyRefinerFactory<Far::TopologyDescriptor> Factory;

template <int WIDTH> struct Value {
    float x[WIDTH];
    void Clear() {
        for (float &value : x) value = 0;
    }
    void AddWithWeight(const Value &v, float w) {
        for (int k = 0; k < WIDTH; k++) x[k] += w * v.x[k];
    }
};

const int *as_int(const uint32_t *p) { return reinterpret_cast<const int *>(p); }

template <typename T> T *allocate(kiln_arena *arena, size_t count) {
    void *p = arena_array(arena, count, sizeof(T));
    if (!p) throw std::bad_alloc();
    return static_cast<T *>(p);
}

Sdc::Options options_of(const kiln_subdivision &r) {
    Sdc::Options o;
    o.SetVtxBoundaryInterpolation(r.boundary == KILN_BOUNDARY_NONE        ? Sdc::Options::VTX_BOUNDARY_NONE
                                  : r.boundary == KILN_BOUNDARY_EDGE_ONLY ? Sdc::Options::VTX_BOUNDARY_EDGE_ONLY
                                                                          : Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    static const Sdc::Options::FVarLinearInterpolation fvar[] = {
        /* KILN_FVAR_CORNERS_PLUS1 */ Sdc::Options::FVAR_LINEAR_CORNERS_PLUS1,
        /* KILN_FVAR_CORNERS_ONLY */ Sdc::Options::FVAR_LINEAR_CORNERS_ONLY,
        /* KILN_FVAR_CORNERS_PLUS2 */ Sdc::Options::FVAR_LINEAR_CORNERS_PLUS2,
        /* KILN_FVAR_NONE */ Sdc::Options::FVAR_LINEAR_NONE,
        /* KILN_FVAR_BOUNDARIES */ Sdc::Options::FVAR_LINEAR_BOUNDARIES,
        /* KILN_FVAR_ALL */ Sdc::Options::FVAR_LINEAR_ALL};
    o.SetFVarLinearInterpolation(fvar[r.fvar_boundary]);
    o.SetCreasingMethod(r.chaikin_creases ? Sdc::Options::CREASE_CHAIKIN : Sdc::Options::CREASE_UNIFORM);
    o.SetTriangleSubdivision(r.smooth_triangles ? Sdc::Options::TRI_SUB_SMOOTH : Sdc::Options::TRI_SUB_CATMARK);
    return o;
}

class Refinement {
  public:
    Refinement(const kiln_cage *cage, uint32_t level, kiln_arena *memory, osd_surface *surface)
        : c(cage), depth(int(level)), arena(memory), out(surface) {}

    void run() {
        refine_topology();
        keep_faces();
        refine_positions();
        out->channels = allocate<osd_values>(arena, c->channel_count);
        int fvar = 0;
        for (uint32_t i = 0; i < c->channel_count; i++) refine_channel(c->channels[i], fvar, out->channels[i]);
        follow_corners();
    }

    // Points whose limits are where the cage's points are.
    float *fit() {
        const int rounds = 10;
        refine_topology();
        Far::PrimvarRefiner primvar(*refiner);
        size_t n = c->vertex_count;
        Point *points = allocate<Point>(arena, c->time_count * n);
        std::memcpy(static_cast<void *>(points), c->positions, c->time_count * n * sizeof *points);
        std::vector<Point> limit(static_cast<size_t>(last().GetNumVertices()));
        for (uint32_t t = 0; t < c->time_count; t++)
            for (int round = 0; round < rounds; round++) {
                std::vector<Point> control = descend_vertices<Point>(points[t * n].x);
                primvar.Limit(control, limit);
                for (size_t v = 0; v < n; v++) {
                    const float *goal = c->positions + 3 * (t * n + v);
                    const Point &reached = limit[size_t(child_vertex(int(v)))];
                    for (int k = 0; k < 3; k++) points[t * n + v].x[k] += goal[k] - reached.x[k];
                }
            }
        return points->x;
    }

  private:
    const kiln_cage *c;
    const int depth;
    kiln_arena *arena;
    osd_surface *out;
    std::unique_ptr<Far::TopologyRefiner> refiner;
    std::vector<int> kept; // faces of the last level that are no holes

    const Far::TopologyLevel &last() const { return refiner->GetLevel(depth); }

    void refine_topology() {
        const kiln_subdivision &r = c->rules;
        Far::TopologyDescriptor d;
        d.numVertices = int(c->vertex_count);
        d.numFaces = int(c->face_count);
        d.numVertsPerFace = as_int(c->face_sizes);
        d.vertIndicesPerFace = as_int(c->face_vertices);
        d.numCreases = int(r.crease_count);
        d.creaseVertexIndexPairs = as_int(r.crease_vertices);
        d.creaseWeights = r.crease_sharpness;
        d.numCorners = int(r.corner_count);
        d.cornerVertexIndices = as_int(r.corner_vertices);
        d.cornerWeights = r.corner_sharpness;
        d.numHoles = int(r.hole_count);
        d.holeIndices = as_int(r.holes);
        std::vector<Far::TopologyDescriptor::FVarChannel> channels;
        for (uint32_t i = 0; i < c->channel_count; i++) {
            if (!c->channels[i].indices) continue;
            Far::TopologyDescriptor::FVarChannel channel;
            channel.numValues = int(c->channels[i].value_count);
            channel.valueIndices = as_int(c->channels[i].indices);
            channels.push_back(channel);
        }
        d.numFVarChannels = int(channels.size());
        d.fvarChannels = channels.data();
        Sdc::SchemeType scheme = r.scheme == KILN_SCHEME_LOOP       ? Sdc::SCHEME_LOOP
                                 : r.scheme == KILN_SCHEME_BILINEAR ? Sdc::SCHEME_BILINEAR
                                                                    : Sdc::SCHEME_CATMARK;
        refiner.reset(Factory::Create(d, Factory::Options(scheme, options_of(r))));
        if (!refiner) throw std::runtime_error("OpenSubdiv refuses the topology");
        Far::TopologyRefiner::UniformOptions uniform(depth);
        uniform.fullTopologyInLastLevel = true; // limits need it
        refiner->RefineUniform(uniform);
    }

    void keep_faces() {
        const Far::TopologyLevel &level = last();
        for (int f = 0; f < level.GetNumFaces(); f++)
            if (!level.IsFaceHole(f)) kept.push_back(f);
        out->vertex_count = uint32_t(level.GetNumVertices());
        out->face_count = uint32_t(kept.size());
        out->face_size = c->rules.scheme == KILN_SCHEME_LOOP ? 3 : 4;
        uint32_t *vertices = allocate<uint32_t>(arena, kept.size() * out->face_size);
        uint32_t *parents = allocate<uint32_t>(arena, kept.size());
        out->face_vertices = vertices;
        out->face_parents = parents;
        for (int f : kept) {
            for (int v : level.GetFaceVertices(f)) *vertices++ = uint32_t(v);
            int parent = f;
            for (int l = depth; l > 0; l--) parent = refiner->GetLevel(l).GetFaceParentFace(parent);
            *parents++ = uint32_t(parent);
        }
    }

    // Values from the cage to the last level. step(level, from, to) refines once, count(level) values each.
    template <typename T, typename COUNT, typename STEP>
    std::vector<T> descend(const float *values, COUNT count, STEP step) const {
        std::vector<T> from(static_cast<size_t>(count(0))), to;
        if (!from.empty()) std::memcpy(static_cast<void *>(from.data()), values, from.size() * sizeof(T));
        for (int l = 1; l <= depth; l++) {
            to.assign(size_t(count(l)), T());
            step(l, from, to);
            from.swap(to);
        }
        return from;
    }
    template <typename T> std::vector<T> descend_vertices(const float *values) const {
        Far::PrimvarRefiner primvar(*refiner);
        return descend<T>(values, [&](int l) { return refiner->GetLevel(l).GetNumVertices(); },
                          [&](int l, const std::vector<T> &from, std::vector<T> &to) {
                              primvar.Interpolate(l, from, to);
                          });
    }
    template <typename T> std::vector<T> descend_corners(const float *values, int channel) const {
        Far::PrimvarRefiner primvar(*refiner);
        return descend<T>(values, [&](int l) { return refiner->GetLevel(l).GetNumFVarValues(channel); },
                          [&](int l, const std::vector<T> &from, std::vector<T> &to) {
                              primvar.InterpolateFaceVarying(l, from, to, channel);
                          });
    }

    void refine_positions() {
        Far::PrimvarRefiner primvar(*refiner);
        size_t n = out->vertex_count;
        Point *limits = allocate<Point>(arena, size_t(c->time_count) * n);
        for (uint32_t t = 0; t < c->time_count; t++) {
            Point *limit = limits + t * n;
            std::vector<Point> control = descend_vertices<Point>(c->positions + 3 * size_t(t) * c->vertex_count);
            primvar.Limit(control, limit);
            // A moving surface has the normals of the middle of the shutter.
            if (t == c->time_count / 2 && c->rules.scheme != KILN_SCHEME_BILINEAR) write_normals(control.data(), limit);
        }
        out->positions = limits->x;
    }

    void write_normals(const Point *control, const Point *limit) {
        kiln_osd::Normals normals;
        kiln_osd::limit_normals(*refiner, control, limit, normals);
        Point *values = allocate<Point>(arena, normals.values.size());
        std::memcpy(static_cast<void *>(values), normals.values.data(), normals.values.size() * sizeof *values);
        out->normals.values = values->x;
        out->normals.value_count = uint32_t(normals.values.size());
        if (normals.values.size() == out->vertex_count) return;
        uint32_t *indices = allocate<uint32_t>(arena, kept.size() * out->face_size);
        out->normals.indices = indices;
        for (int f : kept) {
            const uint32_t *values_of_face = &normals.corner_values[size_t(f) * out->face_size];
            for (uint32_t k = 0; k < out->face_size; k++) *indices++ = values_of_face[k];
        }
    }

    void refine_channel(const cage_channel &channel, int &fvar, osd_values &values) {
        if (channel.width == 2) refine_values<Value<2>>(channel, fvar, values);
        else if (channel.width == 3) refine_values<Value<3>>(channel, fvar, values);
        else refine_values<Value<4>>(channel, fvar, values);
    }

    template <typename T> void refine_values(const cage_channel &channel, int &fvar, osd_values &values) {
        Far::PrimvarRefiner primvar(*refiner);
        bool corners = channel.indices != nullptr;
        std::vector<T> refined =
            corners ? descend_corners<T>(channel.values, fvar) : descend_vertices<T>(channel.values);
        T *limit = allocate<T>(arena, refined.size());
        if (corners) primvar.LimitFaceVarying(refined, limit, fvar);
        else primvar.Limit(refined, limit);
        values.values = limit->x;
        values.value_count = uint32_t(refined.size());
        if (!corners) return;
        uint32_t *indices = allocate<uint32_t>(arena, kept.size() * out->face_size);
        values.indices = indices;
        for (int f : kept)
            for (int i : last().GetFaceFVarValues(f, fvar)) *indices++ = uint32_t(i);
        fvar++;
    }

    int child_vertex(int vertex) const {
        for (int l = 0; l < depth; l++) vertex = refiner->GetLevel(l).GetVertexChildVertex(vertex);
        return vertex;
    }

    // The corner of a child face that lies where corner k of face f does; -1: the face was not refined.
    int child_corner(int l, int f, int k, int &child) const {
        const Far::TopologyLevel &level = refiner->GetLevel(l);
        int vertex = level.GetVertexChildVertex(level.GetFaceVertices(f)[k]);
        Far::ConstIndexArray children = level.GetFaceChildFaces(f);
        // Child k holds the parent's corner k in every scheme; the loop is for polygons that pass a vertex twice.
        for (int i = 0; i < children.size(); i++) {
            child = children[(k + i) % children.size()];
            Far::ConstIndexArray vertices = refiner->GetLevel(l + 1).GetFaceVertices(child);
            for (int j = 0; j < vertices.size(); j++)
                if (vertices[j] == vertex) return j;
        }
        return -1;
    }

    void follow_corners() {
        std::vector<uint32_t> position(size_t(last().GetNumFaces()), UINT32_MAX); // among the kept faces
        for (size_t i = 0; i < kept.size(); i++) position[size_t(kept[i])] = uint32_t(i);
        uint32_t *corners = allocate<uint32_t>(arena, c->corner_count);
        out->cage_corners = corners;
        for (uint32_t f = 0; f < c->face_count; f++)
            for (uint32_t k = 0; k < c->face_sizes[f]; k++) {
                int face = int(f), corner = int(k);
                for (int l = 0; l < depth && corner >= 0; l++) corner = child_corner(l, face, corner, face);
                bool found = corner >= 0 && position[size_t(face)] != UINT32_MAX;
                *corners++ = found ? position[size_t(face)] * out->face_size + uint32_t(corner) : UINT32_MAX;
            }
    }
};

static_assert(std::is_standard_layout<Point>::value && sizeof(Point) == 3 * sizeof(float), "points are bare floats");

// Runs work; turns what it throws into an error.
template <typename WORK> bool guarded(WORK work, const kiln_where *where, kiln_report *report) {
    try {
        work();
        return true;
    } catch (const std::bad_alloc &) {
        return report_no_memory(report, "subdividing a mesh");
    } catch (const std::exception &e) {
        return report_error(report, KILN_CODE_INTERNAL, where, "render with --subdivide off", "subdivision failed: %s",
                            e.what());
    } catch (...) {
        return report_error(report, KILN_CODE_INTERNAL, where, "render with --subdivide off", "subdivision failed");
    }
}

}  // namespace

bool osd_refine(const kiln_cage *c, uint32_t level, kiln_arena *arena, osd_surface *out, const kiln_where *where,
                kiln_report *report) {
    *out = osd_surface();
    return guarded([&] { Refinement(c, level, arena, out).run(); }, where, report);
}

bool osd_fit(kiln_cage *c, kiln_arena *arena, const kiln_where *where, kiln_report *report) {
    return guarded([&] { c->positions = Refinement(c, 1, arena, nullptr).fit(); }, where, report);
}
