#include "kinequad/measure/symmetry_error.h"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "kinequad/core/error.h"
#include "kinequad/core/parallel.h"

namespace kinequad {

double measure_symmetry_error(const StretchReference& reference, const SymmetryMap& symmetry,
                              const Context& context) {
    const auto m = static_cast<std::size_t>(reference.F.rows());
    require(symmetry.centre_image.size() == m &&
                symmetry.transport.size() == static_cast<Eigen::Index>(m),
            InputFault::mesh, "the symmetry map is that of another mesh; make it anew");
    const QuadCrosses crosses(reference);
    constexpr std::size_t block_size = 512;
    // Two sums a block, added up in the order of the blocks.
    std::vector<std::array<double, 2>> sums((m + block_size - 1) / block_size, {0, 0});
    parallel_for(m, block_size, context, [&](std::size_t begin, std::size_t end) {
        auto& [area_sum, weighted] = sums[begin / block_size];
        int hint = -1;
        int image_hint = -1;
        for (std::size_t t = begin; t < end; ++t) {
            const SurfacePoint& image = symmetry.centre_image[t];
            if (image.triangle < 0) continue;
            const QuadCrosses::Cross here =
                crosses.find({static_cast<int>(t), Vector3::Constant(1.0 / 3)}, hint);
            const QuadCrosses::Cross there = crosses.find(image, image_hint);
            hint = here.hint;
            image_hint = there.hint;
            if (here.fourth_power == Complex(0) || there.fourth_power == Complex(0)) continue;
            const double phi = symmetry.transport[static_cast<Eigen::Index>(t)];
            const Complex mirrored = std::polar(1.0, 4 * phi) * std::conj(here.fourth_power);
            const double angle = std::abs(std::arg(there.fourth_power * std::conj(mirrored))) / 4;
            const double area =
                0.5 * std::abs(crosses.rest_shape(static_cast<int>(t)).determinant());
            area_sum += area;
            weighted += area * angle * (180 / std::numbers::pi);
        }
    });
    double area_sum = 0;
    double weighted = 0;
    for (const auto& [area, part] : sums) {
        area_sum += area;
        weighted += part;
    }
    return area_sum > 0 ? weighted / area_sum : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace kinequad
