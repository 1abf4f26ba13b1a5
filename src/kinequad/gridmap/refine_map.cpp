#include "kinequad/gridmap/refine_map.h"

#include <cmath>

#include "kinequad/core/index.h"
#include "kinequad/gridmap/corner_form.h"

namespace kinequad {
namespace {

using Form = LinearForm<double>;
using RealCorner = CornerForm<double>;

/// Rows of `MapVariables` opened up for changes. New vertex columns are numbered after the chain
/// columns until `close` puts them where they belong.
class Refinement {
public:
    Refinement(ChartedMesh& mesh, MapVariables& variables, Eigen::VectorXd x)
        : mesh_(mesh), variables_(variables), values_(x.data(), x.data() + x.size()) {
        corners_.resize(variables.row_start.size() / 2);
        for (std::size_t c = 0; c < corners_.size(); ++c) {
            corners_[c] = {row(2 * c), row(2 * c + 1)};
        }
    }

    void split(int h) {
        const int n = Topology::next(h);
        const int g = mesh_.twin[at(h)];
        const int turns = mesh_.rotation[at(h)];
        const RealCorner a = corners_[at(h)];
        const RealCorner b = corners_[at(n)];
        RealCorner middle;
        if (g >= 0 && !mesh_.is_line[at(h)]) {
            middle = {new_column((value(a.u) + value(b.u)) / 2),
                      new_column((value(a.v) + value(b.v)) / 2)};
        } else {
            // On the boundary and on lines one coordinate stays that of the line.
            const Complex along(value(b.u) - value(a.u), value(b.v) - value(a.v));
            if (std::abs(along.real()) > std::abs(along.imag())) {
                middle = {new_column((value(a.u) + value(b.u)) / 2), a.v};
            } else {
                middle = {a.u, new_column((value(a.v) + value(b.v)) / 2)};
            }
        }
        RealCorner across;
        if (g >= 0) {
            const RealCorner shift =
                add(corners_[at(Topology::next(g))], turned(turned(a, turns), 2));
            across = add(turned(middle, turns), shift);
        }
        const int fresh = static_cast<int>(corners_.size());
        mesh_.split_edge(h);
        put(h, fresh, middle);
        if (g >= 0) put(g, fresh + 3, across);
        variables_.is_node.push_back(0);
    }

    Eigen::VectorXd close() {
        const int old_columns = variables_.columns();
        const int fresh = static_cast<int>(values_.size()) - old_columns;
        const auto renumber = [&](int column) {
            if (column < variables_.vertex_columns) return column;
            return column < old_columns ? column + fresh : column - variables_.chain_columns;
        };
        Eigen::VectorXd x(static_cast<Eigen::Index>(values_.size()));
        for (int c = 0; c < static_cast<int>(values_.size()); ++c) x[renumber(c)] = values_[at(c)];
        variables_.row_start.assign(1, 0);
        variables_.column.clear();
        variables_.coefficient.clear();
        for (const RealCorner& corner : corners_) {
            for (const Form* form : {&corner.u, &corner.v}) {
                for (const auto& [column, c] : *form) {
                    variables_.column.push_back(renumber(column));
                    variables_.coefficient.push_back(c);
                }
                variables_.row_start.push_back(static_cast<int>(variables_.column.size()));
            }
        }
        variables_.vertex_columns += fresh;
        variables_.integer_part.clear();
        return x;
    }

private:
    Form row(std::size_t i) const {
        Form form;
        for (int k = variables_.row_start[i]; k < variables_.row_start[i + 1]; ++k) {
            form.emplace_back(variables_.column[at(k)], variables_.coefficient[at(k)]);
        }
        return form;
    }

    double value(const Form& form) const {
        double sum = 0;
        for (const auto& [column, c] : form) sum += c * values_[at(column)];
        return sum;
    }

    Form new_column(double value) {
        values_.push_back(value);
        return {{static_cast<int>(values_.size()) - 1, 1.0}};
    }

    /// Mirrors what `ChartedMesh::split_edge` did to the corners of the triangle of `h`.
    void put(int h, int fresh, const RealCorner& middle) {
        const RealCorner b = corners_[at(Topology::next(h))];
        const RealCorner c = corners_[at(Topology::previous(h))];
        corners_.resize(at(fresh + 3));
        corners_[at(fresh)] = middle;
        corners_[at(fresh + 1)] = b;
        corners_[at(fresh + 2)] = c;
        corners_[at(Topology::next(h))] = middle;
    }

    ChartedMesh& mesh_;
    MapVariables& variables_;
    std::vector<double> values_;
    std::vector<RealCorner> corners_;
};

}  // namespace

Eigen::VectorXd refine_map(ChartedMesh& mesh, MapVariables& variables, Eigen::VectorXd x,
                           const std::vector<int>& half_edges) {
    Refinement refinement(mesh, variables, std::move(x));
    for (const int h : half_edges) refinement.split(h);
    return refinement.close();
}

}  // namespace kinequad
