#include "kinequad/report/render_panels.h"

#include <algorithm>
#include <utility>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/report/draw_text.h"

namespace kinequad {

Image render_panels(const std::vector<RenderPanel>& panels, int columns,
                    const RenderOptions& options, const Context& context) {
    require(!panels.empty() && columns >= 1, InputFault::usage,
            "a picture of panels needs at least one panel and one column");
    const int count = static_cast<int>(panels.size());
    columns = std::min(columns, count);
    const int rows = (count + columns - 1) / columns;
    Image image{options.width, options.height, {}};
    require(options.width >= columns && options.height >= rows, InputFault::usage,
            "the picture is too small for its panels; make it larger");
    image.rgb.resize(image.offset(0, options.height));
    const bool any_caption = std::any_of(panels.begin(), panels.end(),
                                         [](const auto& panel) { return !panel.caption.empty(); });
    for (int i = 0; i < count; ++i) {
        const RenderPanel& panel = panels[at(i)];
        const int left =
            static_cast<int>(static_cast<long long>(i % columns) * options.width / columns);
        const int right =
            static_cast<int>(static_cast<long long>(i % columns + 1) * options.width / columns);
        const int top =
            static_cast<int>(static_cast<long long>(i / columns) * options.height / rows);
        const int bottom =
            static_cast<int>(static_cast<long long>(i / columns + 1) * options.height / rows);
        RenderOptions part = options;
        part.width = right - left;
        part.height = bottom - top;
        const double letters = std::clamp(0.022 * part.height, 7.0, 22.0);
        // The caption's strip is kept free below the scene and, for balance, above it.
        if (any_caption) part.margin += 2.2 * letters / std::min(part.width, part.height);
        Image drawn = render_mesh(panel.scene, panel.camera, part, context);
        if (!panel.caption.empty()) {
            const double wanted = text_width(panel.caption, letters);
            const double shown = std::min(1.0, 0.94 * part.width / wanted);
            drawn = draw_text(std::move(drawn), panel.caption, 0.5 * (part.width - shown * wanted),
                              part.height - letters, shown * letters, Color(0.2, 0.22, 0.27));
        }
        for (int y = 0; y < part.height; ++y) {
            const auto from = drawn.rgb.begin() + static_cast<std::ptrdiff_t>(drawn.offset(0, y));
            std::copy(from, from + std::ptrdiff_t{3} * part.width,
                      image.rgb.begin() + static_cast<std::ptrdiff_t>(image.offset(left, top + y)));
        }
    }
    return image;
}

}  // namespace kinequad
