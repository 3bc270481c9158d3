#include "importers/subdiv/osd_normals.hpp"

#include <opensubdiv/sdc/catmarkScheme.h>
#include <opensubdiv/sdc/loopScheme.h>

#include <algorithm>
#include <cmath>

namespace kiln_osd {
namespace {

using OpenSubdiv::Far::ConstIndexArray;
using OpenSubdiv::Far::ConstLocalIndexArray;
using OpenSubdiv::Far::Index;
using OpenSubdiv::Far::TopologyLevel;
using OpenSubdiv::Far::TopologyRefiner;
namespace Sdc = OpenSubdiv::Sdc;

struct Vector {
    double x = 0, y = 0, z = 0;
    void add(const Point &p, double w) {
        x += w * p.x[0];
        y += w * p.x[1];
        z += w * p.x[2];
    }
};

Vector difference(const Point &a, const Point &b) {
    return {double(a.x[0]) - b.x[0], double(a.x[1]) - b.x[1], double(a.x[2]) - b.x[2]};
}
Vector cross(const Vector &a, const Vector &b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double length(const Vector &a) { return std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z); }
// The zero vector stays zero.
Point unit(const Vector &a) {
    double l = length(a), s = l > 0 ? 1 / l : 0;
    return {{float(a.x * s), float(a.y * s), float(a.z * s)}};
}

// Faces around a vertex that hang together, counter-clockwise, up to sharp edges or boundaries.
struct Sector {
    std::vector<int> faces; // positions in the vertex's list of faces
    bool closed;            // all around the vertex: it ends where it began
};

// A vertex with nothing but a sector around it, for the masks of Sdc::Scheme. An open sector is a boundary.
struct SectorVertex {
    int edges, faces;
    int GetNumEdges() const { return edges; }
    int GetNumFaces() const { return faces; }
    float *GetSharpnessPerEdge(float sharpness[]) const {
        std::fill(sharpness, sharpness + edges, 0.0f);
        sharpness[0] = sharpness[edges - 1] = Sdc::Crease::SHARPNESS_INFINITE;
        return sharpness;
    }
};

class Mask {
  public:
    typedef double Weight;
    explicit Mask(int edges) : edge(size_t(edges) + 1), face(size_t(edges) + 1) {}
    int GetNumVertexWeights() const { return 1; }
    int GetNumEdgeWeights() const { return edge_count; }
    int GetNumFaceWeights() const { return face_count; }
    void SetNumVertexWeights(int) {}
    void SetNumEdgeWeights(int n) { edge_count = n; }
    void SetNumFaceWeights(int n) { face_count = n; }
    double &VertexWeight(int) { return vertex; }
    double &EdgeWeight(int i) { return edge[size_t(i)]; }
    double &FaceWeight(int i) { return face[size_t(i)]; }
    bool AreFaceWeightsForFaceCenters() const { return false; }
    void SetFaceWeightsForFaceCenters(bool) {}

    Vector apply(const Point &v, const std::vector<Point> &e, const std::vector<Point> &f) const {
        Vector sum;
        sum.add(v, vertex);
        for (int i = 0; i < edge_count && size_t(i) < e.size(); i++) sum.add(e[size_t(i)], edge[size_t(i)]);
        for (int i = 0; i < face_count && size_t(i) < f.size(); i++) sum.add(f[size_t(i)], face[size_t(i)]);
        return sum;
    }

  private:
    double vertex = 0;
    std::vector<double> edge, face;
    int edge_count = 0, face_count = 0;
};

class Builder {
  public:
    Builder(const TopologyRefiner &r, const Point *control_points, const Point *limit_points, Normals &normals)
        : refiner(r), level(r.GetLevel(r.GetMaxLevel())), control(control_points), limit(limit_points), out(normals) {}

    void run() {
        face_size = refiner.GetSchemeType() == Sdc::SCHEME_LOOP ? 3 : 4;
        out.values.assign(size_t(level.GetNumVertices()), Point{{0, 0, 0}});
        out.corner_values.resize(size_t(level.GetNumFaces()) * size_t(face_size));
        for (int v = 0; v < level.GetNumVertices(); v++) visit(v);
    }

  private:
    const TopologyRefiner &refiner;
    const TopologyLevel &level;
    const Point *control, *limit;
    Normals &out;
    int face_size = 0;
    Index vertex = 0;
    ConstIndexArray faces;
    ConstLocalIndexArray locals;
    std::vector<Index> lead, trail; // edges of the vertex before and after each of its faces, counter-clockwise
    std::vector<Point> edge_points, face_points;

    Index corner(int i, int offset) const { return level.GetFaceVertices(faces[i])[(locals[i] + offset) % face_size]; }

    // Semi-sharp edges that need less than one more step are about to be smooth.
    bool splits(Index e) const {
        return level.IsEdgeInfSharp(e) || level.GetEdgeFaces(e).size() != 2 || level.IsEdgeNonManifold(e) ||
               level.GetEdgeSharpness(e) >= 1;
    }

    void visit(Index v) {
        vertex = v;
        faces = level.GetVertexFaces(v);
        locals = level.GetVertexFaceLocalIndices(v);
        int n = faces.size();
        lead.resize(size_t(n));
        trail.resize(size_t(n));
        for (int i = 0; i < n; i++) {
            ConstIndexArray edges = level.GetFaceEdges(faces[i]);
            lead[size_t(i)] = edges[locals[i]];
            trail[size_t(i)] = edges[(locals[i] + face_size - 1) % face_size];
        }
        bool first = true;
        for (const Sector &sector : sectors(n)) {
            Point normal = sector_normal(sector);
            uint32_t index = first ? uint32_t(v) : uint32_t(out.values.size());
            if (first) out.values[size_t(v)] = normal;
            else out.values.push_back(normal);
            first = false;
            for (int i : sector.faces) out.corner_values[size_t(faces[i]) * size_t(face_size) + locals[i]] = index;
        }
    }

    // The face behind face i, over an edge that does not split; -1: none. The lists of manifold vertices are sorted.
    int following(int i, int n) const {
        Index edge = trail[size_t(i)];
        if (splits(edge)) return -1;
        int next = i + 1 < n ? i + 1 : 0;
        if (lead[size_t(next)] == edge) return next;
        for (int j = 0; j < n; j++)
            if (j != i && lead[size_t(j)] == edge) return j;
        return -1;
    }

    std::vector<Sector> sectors(int n) const {
        std::vector<int> next(static_cast<size_t>(n));
        std::vector<char> taken(size_t(n), 0), has_previous(size_t(n), 0);
        for (int i = 0; i < n; i++) {
            next[size_t(i)] = following(i, n);
            if (next[size_t(i)] >= 0) has_previous[size_t(next[size_t(i)])] = 1;
        }
        std::vector<Sector> result;
        for (int pass = 0; pass < 2; pass++) // chains first, then what is left: rings
            for (int start = 0; start < n; start++) {
                if (taken[size_t(start)] || (pass == 0 && has_previous[size_t(start)])) continue;
                Sector s{{}, pass == 1};
                for (int i = start; i >= 0 && !taken[size_t(i)]; i = next[size_t(i)]) {
                    taken[size_t(i)] = 1;
                    s.faces.push_back(i);
                }
                // A dart: one sharp edge, which the surface goes around smoothly.
                if (pass == 0 && lead[size_t(start)] == trail[size_t(s.faces.back())]) s.closed = true;
                result.push_back(std::move(s));
            }
        return result;
    }

    // The mean of the corners of the faces, weighted by area.
    Vector mean_normal(const Sector &s) const {
        Vector sum;
        for (int i : s.faces) {
            Vector n = cross(difference(limit[corner(i, 1)], limit[vertex]),
                             difference(limit[corner(i, face_size - 1)], limit[vertex]));
            sum.x += n.x;
            sum.y += n.y;
            sum.z += n.z;
        }
        return sum;
    }

    bool has_mask(const Sector &s) const {
        if (level.IsVertexNonManifold(vertex)) return false;
        if (s.closed) return s.faces.size() > 1 && level.GetVertexSharpness(vertex) < 1;
        return level.GetVertexRule(vertex) == Sdc::Crease::RULE_CREASE && !level.IsVertexInfSharp(vertex);
    }

    template <Sdc::SchemeType SCHEME> Vector mask_normal(const Sector &s) {
        int count = int(s.faces.size());
        SectorVertex hood = {s.closed ? count : count + 1, count};
        edge_points.clear();
        face_points.clear();
        for (int i : s.faces) {
            edge_points.push_back(control[corner(i, 1)]);
            face_points.push_back(control[corner(i, 2)]); // opposite in a quad; Loop's masks have no such weights
        }
        if (!s.closed) edge_points.push_back(control[corner(s.faces.back(), face_size - 1)]);
        Mask position(hood.edges), tangent1(hood.edges), tangent2(hood.edges);
        Sdc::Scheme<SCHEME>(refiner.GetSchemeOptions())
            .ComputeVertexLimitMask(hood, position, tangent1, tangent2,
                                    s.closed ? Sdc::Crease::RULE_SMOOTH : Sdc::Crease::RULE_CREASE);
        return cross(tangent1.apply(control[vertex], edge_points, face_points),
                     tangent2.apply(control[vertex], edge_points, face_points));
    }

    Point sector_normal(const Sector &s) {
        if (has_mask(s)) {
            Vector n = face_size == 3 ? mask_normal<Sdc::SCHEME_LOOP>(s) : mask_normal<Sdc::SCHEME_CATMARK>(s);
            if (length(n) > 0 && std::isfinite(length(n))) return unit(n);
        }
        return unit(mean_normal(s));
    }
};

}  // namespace

void limit_normals(const TopologyRefiner &refiner, const Point *control, const Point *limit, Normals &out) {
    Builder(refiner, control, limit, out).run();
}

}  // namespace kiln_osd
