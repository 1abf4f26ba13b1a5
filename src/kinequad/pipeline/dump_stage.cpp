#include "kinequad/pipeline/dump_stage.h"

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "kinequad/field/trace_streamlines.h"
#include "kinequad/io/files.h"
#include "kinequad/symmetry/format_symmetry_json.h"

namespace kinequad {
namespace {

using Json = nlohmann::ordered_json;

template <class Scalar>
Json list(const Eigen::Matrix<Scalar, Eigen::Dynamic, 1>& values) {
    return std::vector<Scalar>(values.data(), values.data() + values.size());
}

Json list(const Eigen::VectorXcd& values) {
    Json result = Json::array();
    for (const Complex& value : values) result.push_back({value.real(), value.imag()});
    return result;
}

template <int columns, class Scalar>
Json rows(const Eigen::Matrix<Scalar, Eigen::Dynamic, columns, Eigen::RowMajor>& matrix) {
    Json result = Json::array();
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
        Json row = Json::array();
        for (int k = 0; k < columns; ++k) row.push_back(matrix(i, k));
        result.push_back(std::move(row));
    }
    return result;
}

Json check_record(const Result& result) {
    return {{"twin", result.topology.twin},
            {"edge", result.topology.edge},
            {"edge_half_edge", result.topology.edge_half_edge},
            {"vertex_half_edge", result.topology.vertex_half_edge},
            {"reference", rows<3>(result.reference)}};
}

Json deformation_record(const DeformationTensors& tensors) {
    return {{"frame_count", tensors.frame_count},
            {"stretch_direction_sum", list(tensors.stretch_direction_sum)},
            {"stretch_sum", list(tensors.stretch_sum)},
            {"stretch_square_sum", list(tensors.stretch_square_sum)},
            {"curvature", list(tensors.curvature)}};
}

Json point_record(const SurfacePoint& point) {
    return {point.triangle, point.barycentric[0], point.barycentric[1], point.barycentric[2]};
}

/// Lines along the arms of the field, ten quad edges each way, as points of the input.
Json streamline_record(const Result& result) {
    const Domain& domain = result.domain;
    Json lines = Json::array();
    for (const std::vector<SurfacePoint>& line :
         trace_streamlines(domain.topology, domain.metric, result.field, 10 * result.edge_length)) {
        Json points = Json::array();
        for (SurfacePoint point : line) {
            point = point_of_input(domain.surface.mesh, point);
            if (result.refined) point = point_of_input(*result.refined, point);
            points.push_back(point_record(point));
        }
        lines.push_back(std::move(points));
    }
    return lines;
}

Json cross_field_record(const Result& result) {
    const CrossField& field = result.field;
    return {{"angle", list(field.angle)},
            {"period_jump", list(field.period_jump)},
            {"index", list(field.index)},
            {"energy", field.energy},
            {"streamlines", streamline_record(result)}};
}

Json map_record(const GridMap& map) {
    Json corners = Json::array();
    for (const GridMap::Coordinate& z : map.corner) corners.push_back({z.u, z.v});
    Json transitions = Json::array();
    for (const GridMap::Transition& transition : map.transition) {
        transitions.push_back(
            {transition.rotation, transition.translation.u, transition.translation.v});
    }
    return {{"fraction_bits", GridMap::fraction_bits},
            {"triangles", rows<3>(map.mesh.F)},
            {"parent", map.mesh.parent},
            {"barycentric", rows<3>(map.mesh.barycentric)},
            {"corner", corners},
            {"transition", transitions},
            {"index", list(map.index)}};
}

Json quads_record(const QuadMesh& quads) {
    Json vertices = Json::array();
    for (const SurfacePoint& point : quads.vertex) {
        vertices.push_back(point_record(point));
    }
    return {{"quads", rows<4>(quads.Q)}, {"vertex", vertices}, {"mirror", quads.mirror}};
}

Json record_of(std::string_view stage, const Result& result) {
    if (stage == "check") return check_record(result);
    if (stage == "metric") {
        return {{"edge_length", list(result.domain.metric.edge_length)},
                {"quad_edge_length", result.edge_length}};
    }
    if (stage == "symmetry") return Json::parse(format_symmetry_json(result.symmetry->map));
    if (stage == "deformation") return deformation_record(result.tensors);
    if (stage == "field") return cross_field_record(result);
    if (stage == "map") return map_record(result.map);
    if (stage == "extraction" || stage == "relaxation") return quads_record(result.quads);
    throw std::invalid_argument("no record of the stage " + std::string(stage));
}

}  // namespace

void dump_stage(const std::filesystem::path& directory, std::string_view stage,
                const Result& so_far) {
    write_file_atomically(directory / (std::string(stage) + ".json"),
                          record_of(stage, so_far).dump() + "\n");
}

}  // namespace kinequad
