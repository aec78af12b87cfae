// SPDX-License-Identifier: MIT
#include "app/mesh_files.hpp"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <numbers>
#include <sstream>

namespace sluice::cli {
namespace {

/// Larger files are not read.
constexpr std::uintmax_t kMostBytes = 256U << 20;

using Corner = std::array<double, 3>;

Error wrong(const std::string& name, const std::string& what, const char* remedy) {
    return {SLUICE_ERROR_INVALID_ARGUMENT, name, what, remedy};
}

Corner minus(const Corner& a, const Corner& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Corner cross(const Corner& a, const Corner& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// The library reads what is no number as 0, so that is looked at before.
Status checkCorners(const std::string& text, const std::string& name) {
    std::istringstream lines(text);
    std::string line;
    for (std::size_t number = 1; std::getline(lines, line); ++number) {
        std::istringstream words(line);
        std::string word;
        if (!(words >> word) || word != "v") {
            continue;
        }
        for (int axis = 0; axis < 3; ++axis) {
            word.clear();
            words >> word;
            double value = 0.0;
            const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
            if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(value)) {
                return wrong(name,
                             fmt::format("line {}: expected a corner of three finite numbers, found \"{}\"", number,
                                         line.substr(0, 80)),
                             "export the mesh again");
            }
        }
    }
    return {};
}

/// A fan about the first corner, if it covers the face.
Status addFace(simulator::Mesh& mesh, const std::vector<std::uint32_t>& face, std::size_t number) {
    std::vector<Corner> areas;
    Corner whole{};
    for (std::size_t i = 1; i + 1 < face.size(); ++i) {
        const Corner& first = mesh.corners[face[0]];
        areas.push_back(cross(minus(mesh.corners[face[i]], first), minus(mesh.corners[face[i + 1]], first)));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            whole.at(axis) += areas.back().at(axis);
        }
        mesh.triangles.push_back({face[0], face[i], face[i + 1]});
    }
    for (const Corner& area : areas) {
        if (areas.size() > 1 && !(area[0] * whole[0] + area[1] * whole[1] + area[2] * whole[2] > 0.0)) {
            return wrong(mesh.name, fmt::format("face {} of {} corners is not convex", number, face.size()),
                         "export the mesh as triangles");
        }
    }
    return {};
}

Status addShape(simulator::Mesh& mesh, const tinyobj::mesh_t& shape, std::size_t& faces) {
    std::size_t at = 0;
    for (const std::size_t corners : shape.num_face_vertices) {
        ++faces;
        std::vector<std::uint32_t> face;
        for (std::size_t i = 0; i < corners && at < shape.indices.size(); ++i, ++at) {
            const int index = shape.indices[at].vertex_index;
            if (index < 0 || static_cast<std::size_t>(index) >= mesh.corners.size()) {
                return wrong(mesh.name,
                             fmt::format("face {} has corner {}, of {}", faces, index + 1, mesh.corners.size()),
                             "export the mesh again");
            }
            face.push_back(static_cast<std::uint32_t>(index));
        }
        if (Status status = addFace(mesh, face, faces); !status) {
            return status;
        }
    }
    // The library counts the corners of a face in a byte on Debian 12.
    return at == shape.indices.size()
               ? Status{}
               : Status{wrong(mesh.name, "has a face of more than 255 corners", "export the mesh as triangles")};
}

Result<std::string> contents(const std::filesystem::path& path) {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (error || size > kMostBytes) {
        return wrong(path.string(),
                     error ? error.message() : fmt::format("has {} bytes, more than {}", size, kMostBytes),
                     error ? "name an OBJ file; the path counts from the scene file" : "simplify the mesh");
    }
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        return wrong(path.string(), std::strerror(errno), "name an OBJ file that can be read");
    }
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

}  // namespace

Result<simulator::Mesh> parseObj(const std::string& text, const std::string& name) {
    if (Status status = checkCorners(text, name); !status) {
        return status.error();
    }
    tinyobj::ObjReaderConfig config;
    config.triangulate = false;
    config.vertex_color = false;
    tinyobj::ObjReader reader;
    if (!reader.ParseFromString(text, "", config)) {
        std::string what = reader.Error();
        what.erase(what.find_last_not_of(" \n") + 1);
        return wrong(name, fmt::format("is not an OBJ file: {}", what.empty() ? "it cannot be read" : what),
                     "export the mesh again");
    }
    simulator::Mesh mesh;
    mesh.name = name;
    const auto& numbers = reader.GetAttrib().vertices;
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
        mesh.corners.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
    }
    std::size_t faces = 0;
    for (const tinyobj::shape_t& shape : reader.GetShapes()) {
        if (Status status = addShape(mesh, shape.mesh, faces); !status) {
            return status.error();
        }
    }
    return mesh;
}

Result<std::vector<simulator::Mesh>> readMeshes(const scene::Simulation& simulation) {
    std::vector<simulator::Mesh> meshes;
    for (const scene::SolidMesh& placed : simulation.meshes) {
        const Result<std::string> text = contents(placed.path);
        if (!text) {
            return text.error();
        }
        Result<simulator::Mesh> mesh = parseObj(text.value(), placed.path);
        if (!mesh) {
            return mesh.error();
        }
        const double angle = double{placed.turn_degrees} * std::numbers::pi / 180.0;
        for (Corner& x : mesh.value().corners) {
            const Corner old = x;
            const auto scale = double{placed.scale};
            x = {double{placed.position[0]} + scale * (std::cos(angle) * old[0] + std::sin(angle) * old[2]),
                 double{placed.position[1]} + scale * old[1],
                 double{placed.position[2]} + scale * (std::cos(angle) * old[2] - std::sin(angle) * old[0])};
            for (double& coordinate : x) {
                coordinate = double{static_cast<float>(coordinate)};
            }
        }
        meshes.push_back(std::move(mesh).value());
    }
    return meshes;
}

std::vector<host::TriangleMesh> drawnMeshes(const std::vector<simulator::Mesh>& meshes) {
    std::vector<host::TriangleMesh> drawn;
    for (const simulator::Mesh& mesh : meshes) {
        host::TriangleMesh& to = drawn.emplace_back();
        to.triangles = mesh.triangles;
        for (const Corner& x : mesh.corners) {
            to.corners.push_back({static_cast<float>(x[0]), static_cast<float>(x[1]), static_cast<float>(x[2])});
        }
    }
    return drawn;
}

}  // namespace sluice::cli
