#include "kinequad/io/triangulate_polygons.h"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "kinequad/core/index.h"

namespace kinequad {
namespace {

// Below this share of the face's area a triangle counts as having none.
constexpr double no_area = 1e-10;
constexpr std::size_t largest_ear_clipped = 128;

using Corners = std::array<int, 3>;

Vector3 point(const Positions& V, int vertex) { return V.row(vertex).transpose(); }

/// Sum of the cross products about the first corner: the normal with twice the area as its length.
Vector3 area_vector(const Positions& V, std::span<const int> face) {
    const Vector3 origin = point(V, face[0]);
    Vector3 sum = Vector3::Zero();
    for (std::size_t k = 1; k + 1 < face.size(); ++k) {
        sum += (point(V, face[k]) - origin).cross(point(V, face[k + 1]) - origin);
    }
    return sum;
}

/// Twice the area of a triangle, negative where it is turned against the unit normal.
double signed_area(const Positions& V, const Corners& t, const Vector3& normal) {
    const Vector3 a = point(V, t[0]);
    return (point(V, t[1]) - a).cross(point(V, t[2]) - a).dot(normal);
}

/// The two triangles of a quad. `normal` and `area` are those of the face that it is part of.
std::array<Corners, 2> cut_quad(const Positions& V, std::span<const int> q, const Vector3& normal,
                                double area) {
    const std::array<Corners, 2> along_02 = {{{q[0], q[1], q[2]}, {q[0], q[2], q[3]}}};
    const std::array<Corners, 2> along_13 = {{{q[0], q[1], q[3]}, {q[1], q[2], q[3]}}};
    const auto smaller_area = [&](const std::array<Corners, 2>& cut) {
        return std::min(signed_area(V, cut[0], normal), signed_area(V, cut[1], normal));
    };
    const double area_02 = smaller_area(along_02);
    const double area_13 = smaller_area(along_13);
    const bool good_02 = area_02 > no_area * area;
    const bool good_13 = area_13 > no_area * area;
    if (good_02 != good_13) return good_02 ? along_02 : along_13;
    if (!good_02) return area_02 >= area_13 ? along_02 : along_13;
    const double length_02 = (point(V, q[2]) - point(V, q[0])).squaredNorm();
    const double length_13 = (point(V, q[3]) - point(V, q[1])).squaredNorm();
    return length_02 <= length_13 ? along_02 : along_13;
}

/// True where no other corner of the remaining polygon lies in the triangle, seen along `normal`.
bool is_empty(const Positions& V, const std::vector<int>& polygon, const Corners& t,
              const Vector3& normal) {
    for (const int vertex : polygon) {
        if (vertex == t[0] || vertex == t[1] || vertex == t[2]) continue;
        if (signed_area(V, {t[0], t[1], vertex}, normal) >= 0 &&
            signed_area(V, {t[1], t[2], vertex}, normal) >= 0 &&
            signed_area(V, {t[2], t[0], vertex}, normal) >= 0) {
            return false;
        }
    }
    return true;
}

/// Index into `polygon` of the ear to cut next: the one with the shortest diagonal, and where none
/// is sound (the face crosses itself or has no area) the corner with the most area.
std::size_t choose_ear(const Positions& V, const std::vector<int>& polygon, const Vector3& normal,
                       double area) {
    const std::size_t n = polygon.size();
    std::size_t best = n;
    double shortest = std::numeric_limits<double>::infinity();
    std::size_t widest = 0;
    double most_area = -std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < n; ++k) {
        const Corners t = {polygon[(k + n - 1) % n], polygon[k], polygon[(k + 1) % n]};
        const double ear_area = signed_area(V, t, normal);
        if (ear_area > most_area) {
            most_area = ear_area;
            widest = k;
        }
        const double length = (point(V, t[2]) - point(V, t[0])).squaredNorm();
        if (length < shortest && ear_area > no_area * area && is_empty(V, polygon, t, normal)) {
            shortest = length;
            best = k;
        }
    }
    return best < n ? best : widest;
}

void cut_polygon(const Positions& V, std::span<const int> face, std::vector<Corners>& triangles) {
    if (face.size() == 3) {
        triangles.push_back({face[0], face[1], face[2]});
        return;
    }
    if (face.size() > largest_ear_clipped) {
        for (std::size_t k = 1; k + 1 < face.size(); ++k) {
            triangles.push_back({face[0], face[k], face[k + 1]});
        }
        return;
    }
    const Vector3 vector = area_vector(V, face);
    const double area = vector.norm();
    const Vector3 normal = area > 0 ? Vector3(vector / area) : Vector3(Vector3::UnitZ());
    std::vector<int> polygon(face.begin(), face.end());
    while (polygon.size() > 4) {
        const std::size_t n = polygon.size();
        const std::size_t k = choose_ear(V, polygon, normal, area);
        triangles.push_back({polygon[(k + n - 1) % n], polygon[k], polygon[(k + 1) % n]});
        polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(k));
    }
    for (const Corners& t : cut_quad(V, polygon, normal, area)) triangles.push_back(t);
}

}  // namespace

Triangles triangulate_polygons(const Positions& V, const Polygons& faces) {
    std::vector<Corners> triangles;
    triangles.reserve(faces.corners.size());
    for (int f = 0; f < faces.count(); ++f) cut_polygon(V, faces[f], triangles);
    Triangles F(static_cast<Eigen::Index>(triangles.size()), 3);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            F(static_cast<Eigen::Index>(t), k) = triangles[t][at(k)];
        }
    }
    return F;
}

}  // namespace kinequad
