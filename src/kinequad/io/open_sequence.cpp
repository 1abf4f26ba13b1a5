#include "kinequad/io/open_sequence.h"

#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include "kinequad/core/error.h"
#include "kinequad/io/file_sequence.h"
#include "kinequad/io/files.h"
#include "kinequad/io/natural_order.h"
#include "kinequad/io/read_polygon_mesh.h"

namespace kinequad {
namespace {

using Path = std::filesystem::path;

bool is_cache_file(const Path& path) {
    const std::string extension = extension_of(path);
    return extension == ".pc2" || extension == ".mdd";
}

/// Files of the same name as `path` with the given extension, in lower or upper case.
std::vector<Path> files_beside(const Path& path, const std::vector<std::string>& extensions) {
    std::vector<Path> found;
    for (const std::string& extension : extensions) {
        std::error_code ignored;
        if (const Path other = Path(path).replace_extension(extension);
            std::filesystem::is_regular_file(other, ignored)) {
            found.push_back(other);
        }
    }
    return found;
}

std::unique_ptr<FrameSource> open_file(const Path& path, const SequenceOptions& options) {
    if (is_cache_file(path)) {
        const std::vector<Path> meshes = files_beside(path, {".obj", ".OBJ"});
        if (meshes.empty()) {
            refuse_file(path.string(),
                        "has no OBJ of the same name beside it; its faces are needed");
        }
        return open_point_cache(meshes.front(), path, options);
    }
    if (extension_of(path) == ".obj") {
        const std::vector<Path> caches = files_beside(path, {".pc2", ".PC2", ".mdd", ".MDD"});
        if (caches.size() > 1) {
            refuse_file(path.string(),
                        fmt::format("has both {} and {} beside it; name the one to be read",
                                    caches[0].filename().string(), caches[1].filename().string()));
        }
        if (!caches.empty()) return open_point_cache(path, caches.front(), options);
    }
    return open_mesh_files({path}, path.string());
}

/// Opens what a folder or a glob holds; other files than meshes and caches are passed over.
std::unique_ptr<FrameSource> open_listing(std::vector<Path> files, const std::string& name,
                                          const SequenceOptions& options) {
    std::erase_if(files, [](const Path& path) {
        std::error_code ignored;
        const bool is_hidden = path.filename().string().starts_with('.');
        return is_hidden || !(is_mesh_file(path) || is_cache_file(path)) ||
               !std::filesystem::is_regular_file(path, ignored);
    });
    std::sort(files.begin(), files.end(), [](const Path& a, const Path& b) {
        return is_naturally_before(a.string(), b.string());
    });
    if (files.empty())
        refuse_file(name, "holds no OBJ, PLY or OFF files; name the frames of a sequence");
    const auto cache = std::find_if(files.begin(), files.end(), is_cache_file);
    const auto meshes = std::count_if(files.begin(), files.end(), is_mesh_file);
    if (cache != files.end()) {
        const auto caches = static_cast<std::ptrdiff_t>(files.size()) - meshes;
        if (caches > 1 || meshes > 1) {
            refuse_file(
                name, fmt::format(
                          "holds the point cache {} among other sequences; name the one to be read",
                          cache->filename().string()));
        }
        return open_file(*cache, options);
    }
    if (files.size() == 1) return open_file(files.front(), options);
    const std::string extension = extension_of(files.front());
    for (const Path& path : files) {
        if (extension_of(path) == extension) continue;
        refuse_file(name, fmt::format("holds both {} and {} files; name one kind, as in \"{}/*{}\"",
                                      extension, extension_of(path), path.parent_path().string(),
                                      extension));
    }
    if (extension == ".stl") {
        refuse_file(
            name,
            "STL files do not keep the order of the vertices; use OBJ, PLY or OFF for a sequence");
    }
    return open_mesh_files(std::move(files), name);
}

std::vector<Path> list_folder(const Path& folder) {
    std::error_code reason;
    std::vector<Path> files;
    std::filesystem::directory_iterator entry(folder, reason);
    for (; !reason && entry != std::filesystem::directory_iterator(); entry.increment(reason)) {
        files.push_back(entry->path());
    }
    if (reason) refuse_file(folder.string(), "cannot be listed: " + reason.message());
    return files;
}

std::vector<Path> expand_glob(const std::string& pattern) {
    ::glob_t matches{};
    const int result = ::glob(pattern.c_str(), GLOB_NOSORT, nullptr, &matches);
    std::vector<Path> files;
    for (std::size_t k = 0; result == 0 && k < matches.gl_pathc; ++k) {
        files.emplace_back(matches.gl_pathv[k]);
    }
    ::globfree(&matches);
    return files;
}

}  // namespace

std::unique_ptr<FrameSource> open_sequence(const std::string& input,
                                           const SequenceOptions& options) {
    std::error_code ignored;
    if (std::filesystem::is_directory(input, ignored)) {
        return open_listing(list_folder(input), input, options);
    }
    if (std::filesystem::exists(input, ignored)) return open_file(input, options);
    if (input.find_first_of("*?[") == std::string::npos) {
        refuse_file(input, "does not exist; name a folder or glob of frames, or a mesh");
    }
    std::vector<Path> files = expand_glob(input);
    if (files.empty())
        refuse_file(input, "matches no file; name a folder or glob of frames, or a mesh");
    return open_listing(std::move(files), input, options);
}

}  // namespace kinequad
