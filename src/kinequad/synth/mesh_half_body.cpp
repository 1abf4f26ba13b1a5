#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "kinequad/core/index.h"
#include "kinequad/core/parallel.h"
#include "kinequad/synth/cell_cases.h"
#include "kinequad/synth/half_mesh.h"

namespace kinequad::synth_detail {
namespace {

constexpr int block_size = 8;  ///< corners, and cells, of a block along an axis
constexpr int block_volume = block_size * block_size * block_size;
using Cell = std::array<int, 3>;

/// A sparse grid: blocks far from the surface keep only their side of it.
class SparseGrid {
public:
    SparseGrid(const ImplicitBody& body, double cell, double shift, const Context& context)
        : body_(body), cell_(cell) {
        // The plane x = 0 halves the first layer of cells, whose vertices then lie in it.
        origin_ = Vector3(-0.5 * cell, body.low().y() - (2 - shift) * cell,
                          body.low().z() - (2 - 0.6 * shift) * cell);
        for (int a = 0; a < 3; ++a) {
            blocks_[at(a)] =
                static_cast<int>(std::ceil((body.high()[a] - origin_[a]) / cell + 3) / block_size) +
                1;
        }
        find_active(context);
        fill(context);
    }

    std::size_t active_count() const { return active_.size(); }
    Cell first_corner(std::size_t active) const {
        const int block = active_[active];
        return {block % blocks_[0] * block_size, block / blocks_[0] % blocks_[1] * block_size,
                block / (blocks_[0] * blocks_[1]) * block_size};
    }
    /// Position of a corner. Corner 0 along x is the mirror image of corner 1.
    Vector3 position(const Cell& corner) const {
        return origin_ + cell_ * Vector3(corner[0], corner[1], corner[2]);
    }
    bool is_outside_grid(const Cell& corner) const {
        return corner[0] >= blocks_[0] * block_size || corner[1] >= blocks_[1] * block_size ||
               corner[2] >= blocks_[2] * block_size;
    }
    /// Value at a corner; beyond active blocks only its sign counts.
    float value(const Cell& corner) const {
        const int block = block_of(corner);
        const int state = state_[at(block)];
        if (state < 0) return state == outside ? 1.0F : -1.0F;
        return values_[index(state, corner)];
    }
    /// Place of a corner, or of the cell above it, in an array over active blocks.
    std::size_t slot(const Cell& corner) const {
        return index(state_[at(block_of(corner))], corner);
    }

private:
    static constexpr int outside = -1;
    static constexpr int inside = -2;

    int block_of(const Cell& corner) const {
        return corner[0] / block_size +
               blocks_[0] * (corner[1] / block_size + blocks_[1] * (corner[2] / block_size));
    }
    static std::size_t index(int active, const Cell& corner) {
        return static_cast<std::size_t>(active) * block_volume +
               static_cast<std::size_t>(
                   corner[0] % block_size +
                   block_size * (corner[1] % block_size + block_size * (corner[2] % block_size)));
    }

    void find_active(const Context& context) {
        const auto count = static_cast<std::size_t>(blocks_[0]) *
                           static_cast<std::size_t>(blocks_[1]) *
                           static_cast<std::size_t>(blocks_[2]);
        state_.resize(count);
        // A block answers for its cells too, which reach one corner farther.
        const double reach = 0.5 * (block_size + 2) * std::sqrt(3.0) * cell_;
        parallel_for(count, 64, context, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const int block = static_cast<int>(i);
                const Cell corner = {block % blocks_[0] * block_size,
                                     block / blocks_[0] % blocks_[1] * block_size,
                                     block / (blocks_[0] * blocks_[1]) * block_size};
                const Vector3 center =
                    position(corner) + Vector3::Constant(0.5 * block_size * cell_);
                const double value = body_.value(center, body_.everything());
                const bool near = std::abs(value) <= ImplicitBody::steepness * reach;
                state_[i] = near ? 0 : (value > 0 ? outside : inside);
            }
        });
        for (std::size_t i = 0; i < count; ++i) {
            if (state_[i] != 0) continue;
            state_[i] = static_cast<int>(active_.size());
            active_.push_back(static_cast<int>(i));
        }
    }

    void fill(const Context& context) {
        values_.resize(active_.size() * block_volume);
        parallel_for(active_.size(), 4, context, [&](std::size_t begin, std::size_t end) {
            for (std::size_t active = begin; active < end; ++active) {
                const Cell first = first_corner(active);
                const double half = 0.5 * block_size * cell_;
                const auto selection = body_.select(position(first) + Vector3::Constant(half),
                                                    std::sqrt(3.0) * (half + cell_));
                for (int k = 0; k < block_volume; ++k) {
                    Vector3 point =
                        position({first[0] + k % block_size, first[1] + k / block_size % block_size,
                                  first[2] + k / (block_size * block_size)});
                    point.x() = std::abs(point.x());
                    values_[active * block_volume + static_cast<std::size_t>(k)] =
                        static_cast<float>(body_.value(point, selection));
                }
            }
        });
    }

    const ImplicitBody& body_;
    double cell_;
    Vector3 origin_;
    std::array<int, 3> blocks_{};
    std::vector<int> state_;   ///< number among the active blocks, or the side of the surface
    std::vector<int> active_;  ///< ascending blocks
    std::vector<float> values_;
};

/// The cells of active blocks that the surface passes through.
class SurfaceCells {
public:
    SurfaceCells(const SparseGrid& grid, const Context& context) : grid_(grid) {
        const std::size_t blocks = grid.active_count();
        mask_.resize(blocks * block_volume);
        first_vertex_.resize(blocks * block_volume);
        std::vector<int> count(blocks + 1, 0);
        parallel_for(blocks, 4, context, [&](std::size_t begin, std::size_t end) {
            for (std::size_t block = begin; block < end; ++block) {
                int vertices = 0;
                for_cells(block, [&](const Cell& cell, std::size_t slot) {
                    mask_[slot] = mask_of(cell);
                    first_vertex_[slot] = vertices;
                    vertices += cell_case(mask_[slot]).piece_count;
                });
                count[block + 1] = vertices;
            }
        });
        for (std::size_t block = 0; block < blocks; ++block) {
            count[block + 1] += count[block];
            for (std::size_t k = 0; k < block_volume; ++k) {
                first_vertex_[block * block_volume + k] += count[block];
            }
        }
        vertex_count_ = static_cast<std::size_t>(count[blocks]);
    }

    std::size_t vertex_count() const { return vertex_count_; }

    template <class Visit>
    void for_cells(std::size_t block, const Visit& visit) const {
        const Cell first = grid_.first_corner(block);
        for (int k = 0; k < block_volume; ++k) {
            visit(Cell{first[0] + k % block_size, first[1] + k / block_size % block_size,
                       first[2] + k / (block_size * block_size)},
                  block * block_volume + static_cast<std::size_t>(k));
        }
    }

    /// Sets the vertices of the cells of a block: the mean of where the surface crosses the edges.
    void place_vertices(std::size_t block, HalfMesh& mesh) const {
        for_cells(block, [&](const Cell& cell, std::size_t slot) {
            const CellCase& here = cell_case(mask_[slot]);
            std::array<Vector3, 4> sum;
            std::array<int, 4> crossings{};
            sum.fill(Vector3::Zero());
            for (int edge = 0; edge < 12; ++edge) {
                const int piece = here.piece[at(edge)];
                if (piece < 0) continue;
                const auto [a, b] = cell_edge_corners(edge);
                const Cell from = corner_of(cell, a);
                const Cell to = corner_of(cell, b);
                const auto from_value = static_cast<double>(grid_.value(from));
                const auto to_value = static_cast<double>(grid_.value(to));
                const double t = from_value / (from_value - to_value);
                sum[at(piece)] += (1 - t) * grid_.position(from) + t * grid_.position(to);
                ++crossings[at(piece)];
            }
            for (int piece = 0; piece < here.piece_count; ++piece) {
                const auto p = static_cast<std::size_t>(piece);
                const std::size_t vertex = static_cast<std::size_t>(first_vertex_[slot]) + p;
                mesh.vertices[vertex] = sum[p] / crossings[p];
                mesh.in_plane[vertex] = cell[0] == 0;
                if (cell[0] == 0) mesh.vertices[vertex].x() = 0;
            }
        });
    }

    /// Quads around the crossed edges whose lower corner is in a block, facing outwards.
    std::vector<std::array<int, 4>> quads_of(std::size_t block) const {
        std::vector<std::array<int, 4>> quads;
        for_cells(block, [&](const Cell& corner, std::size_t) {
            // Edges in the layer behind the plane are the mirror images of those before it.
            if (corner[0] == 0) return;
            const bool inside = grid_.value(corner) < 0;
            for (int axis = 0; axis < 3; ++axis) {
                Cell far = corner;
                ++far[at(axis)];
                if (at_end(far) || (grid_.value(far) < 0) == inside) continue;
                constexpr std::array<std::array<int, 2>, 4> around{
                    {{1, 1}, {0, 1}, {0, 0}, {1, 0}}};
                std::array<int, 4> quad{};
                for (std::size_t k = 0; k < 4; ++k) {
                    const auto [u, v] = around[k];
                    Cell cell = corner;
                    cell[at((axis + 1) % 3)] -= u;
                    cell[at((axis + 2) % 3)] -= v;
                    const std::size_t slot = grid_.slot(cell);
                    const int edge = 4 * axis + u + 2 * v;
                    quad[k] = first_vertex_[slot] + cell_case(mask_[slot]).piece[at(edge)];
                }
                if (!inside) std::swap(quad[1], quad[3]);
                quads.push_back(quad);
            }
        });
        return quads;
    }

private:
    /// The body ends before the last corners of the grid.
    bool at_end(const Cell& corner) const { return grid_.is_outside_grid(corner); }
    static Cell corner_of(const Cell& cell, int corner) {
        return {cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1), cell[2] + (corner >> 2)};
    }
    std::uint8_t mask_of(const Cell& cell) const {
        unsigned mask = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const Cell at = corner_of(cell, corner);
            if (!at_end(at) && grid_.value(at) < 0) mask |= 1U << corner;
        }
        return static_cast<std::uint8_t>(mask);
    }

    const SparseGrid& grid_;
    std::vector<std::uint8_t> mask_;
    std::vector<int> first_vertex_;
    std::size_t vertex_count_ = 0;
};

void project_all(const ImplicitBody& body, HalfMesh& mesh, const Context& context) {
    parallel_for(mesh.vertices.size(), 256, context, [&](std::size_t begin, std::size_t end) {
        Vector3 low = mesh.vertices[begin];
        Vector3 high = low;
        for (std::size_t v = begin; v < end; ++v) {
            low = low.cwiseMin(mesh.vertices[v]);
            high = high.cwiseMax(mesh.vertices[v]);
        }
        const auto selection = body.select(0.5 * (low + high), 0.6 * (high - low).norm() + 1e-3);
        for (std::size_t v = begin; v < end; ++v) {
            mesh.vertices[v] = body.project(mesh.vertices[v], mesh.in_plane[v] != 0, selection);
        }
    });
}

}  // namespace

HalfMesh mesh_half_body(const ImplicitBody& body, double cell, double shift,
                        const Context& context) {
    const SparseGrid grid(body, cell, shift, context);
    const SurfaceCells cells(grid, context);
    HalfMesh mesh;
    mesh.vertices.resize(cells.vertex_count());
    mesh.in_plane.resize(cells.vertex_count());
    const std::size_t blocks = grid.active_count();
    std::vector<std::vector<std::array<int, 4>>> quads(blocks);
    parallel_for(blocks, 4, context, [&](std::size_t begin, std::size_t end) {
        for (std::size_t block = begin; block < end; ++block) {
            cells.place_vertices(block, mesh);
            quads[block] = cells.quads_of(block);
        }
    });
    project_all(body, mesh, context);
    for (const auto& of_block : quads) {
        for (const auto& [a, b, c, d] : of_block) {
            const auto squared = [&](int i, int j) {
                return (mesh.vertices[at(i)] - mesh.vertices[at(j)]).squaredNorm();
            };
            if (squared(a, c) <= squared(b, d)) {
                mesh.triangles.push_back({a, b, c});
                mesh.triangles.push_back({a, c, d});
            } else {
                mesh.triangles.push_back({a, b, d});
                mesh.triangles.push_back({b, c, d});
            }
        }
    }
    return mesh;
}

}  // namespace kinequad::synth_detail
