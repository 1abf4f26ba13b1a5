#include "kinequad/mesh/find_crossings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>

#include "kinequad/core/index.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {
namespace {

using Box = Eigen::AlignedBox3d;

constexpr int leaf_size = 4;

/// Sign of the volume of a tetrahedron; 0 within rounding.
int side(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& p) {
    const Vector3 u = b - a;
    const Vector3 v = c - a;
    const Vector3 w = p - a;
    const double volume = u.cross(v).dot(w);
    const double error = 1e-14 * u.norm() * v.norm() * w.norm();
    return volume > error ? 1 : volume < -error ? -1 : 0;
}

bool crosses(const Vector3& p, const Vector3& q, const std::array<Vector3, 3>& t) {
    if (side(t[0], t[1], t[2], p) * side(t[0], t[1], t[2], q) >= 0) return false;
    const int first = side(p, q, t[0], t[1]);
    return first != 0 && first == side(p, q, t[1], t[2]) && first == side(p, q, t[2], t[0]);
}

class Search {
public:
    Search(const Triangles& F, const Positions& V, int most, const Context& context)
        : F_(F), V_(V), most_(at(most)), context_(context) {
        order_.resize(at(F.rows()));
        std::iota(order_.begin(), order_.end(), 0);
        if (!order_.empty()) build(0, static_cast<int>(order_.size()));
    }

    std::vector<std::array<int, 2>> run() {
        if (!nodes_.empty()) meet(0, 0);
        for (std::array<int, 2>& pair : found_) std::sort(pair.begin(), pair.end());
        std::sort(found_.begin(), found_.end());
        return std::move(found_);
    }

private:
    struct Node {
        Box box;
        int begin;
        int end;
        int left = -1;  ///< -1 at a leaf; the right child otherwise follows the left subtree
        int right = -1;
    };

    Vector3 corner(int t, int k) const { return V_.row(F_(t, k)).transpose(); }

    int build(int begin, int end) {
        const auto number = static_cast<int>(nodes_.size());
        nodes_.push_back({Box(), begin, end});
        Box box;
        Box centres;
        for (int i = begin; i < end; ++i) {
            const int t = order_[at(i)];
            for (int k = 0; k < 3; ++k) box.extend(corner(t, k));
            centres.extend(centre(t));
        }
        nodes_[at(number)].box = box;
        if (end - begin <= leaf_size) return number;
        Eigen::Index axis = 0;
        centres.sizes().maxCoeff(&axis);
        const int middle = (begin + end) / 2;
        std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                         [&](int a, int b) {
                             const double x = centre(a)[axis];
                             const double y = centre(b)[axis];
                             return x != y ? x < y : a < b;
                         });
        const int left = build(begin, middle);
        const int right = build(middle, end);
        nodes_[at(number)].left = left;
        nodes_[at(number)].right = right;
        return number;
    }

    Vector3 centre(int t) const { return triangle_centre(V_, F_, t); }

    void meet(int a, int b) {
        if (found_.size() >= most_) return;
        const Node& x = nodes_[at(a)];
        const Node& y = nodes_[at(b)];
        if (!x.box.intersects(y.box)) return;
        if (x.left < 0 && y.left < 0) {
            context_.check_cancelled();
            test_leaves(x, y);
        } else if (a == b) {
            meet(x.left, x.left);
            meet(x.left, x.right);
            meet(x.right, x.right);
        } else if (y.left < 0 || (x.left >= 0 && x.end - x.begin > y.end - y.begin)) {
            meet(x.left, b);
            meet(x.right, b);
        } else {
            meet(a, y.left);
            meet(a, y.right);
        }
    }

    void test_leaves(const Node& x, const Node& y) {
        for (int i = x.begin; i < x.end; ++i) {
            for (int j = &x == &y ? i + 1 : y.begin; j < y.end; ++j) {
                const int s = order_[at(i)];
                const int t = order_[at(j)];
                if (found_.size() < most_ && are_crossing(s, t)) found_.push_back({s, t});
            }
        }
    }

    bool are_crossing(int s, int t) const {
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) {
                if (F_(s, i) == F_(t, j)) return false;
            }
        }
        const std::array<Vector3, 3> a = {corner(s, 0), corner(s, 1), corner(s, 2)};
        const std::array<Vector3, 3> b = {corner(t, 0), corner(t, 1), corner(t, 2)};
        for (std::size_t i = 0; i < 3; ++i) {
            if (crosses(a[i], a[(i + 1) % 3], b) || crosses(b[i], b[(i + 1) % 3], a)) return true;
        }
        return false;
    }

    const Triangles& F_;
    const Positions& V_;
    std::size_t most_;
    const Context& context_;
    std::vector<int> order_;
    std::vector<Node> nodes_;
    std::vector<std::array<int, 2>> found_;
};

}  // namespace

std::vector<std::array<int, 2>> find_crossing_triangles(const Triangles& F, const Positions& V,
                                                        int most, const Context& context) {
    return Search(F, V, most, context).run();
}

}  // namespace kinequad
