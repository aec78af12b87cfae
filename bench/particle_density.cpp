// SPDX-License-Identifier: MIT
// The density error of anybody's particles by one measure, in double precision and on the CPU, over the particles that
// are farther than the support from every wall.
//   particle_density KERNEL VOLUME X Y Z FILE.pos...
// KERNEL: cubic (spline, Monaghan 1992) or poly6 (Mueller et al. 2003), supports of four radii, or wendland (C2), of
// six. VOLUME: of a particle at rest as its solver defines it, in (2 radii)^3; a cubic lattice of such has density 1.
// X, Y, Z: the walls are at 0 and there, metres. Printed: mean and greatest of max(density - 1, 0), over all files; the
// standard deviation of the density, which depends on no definition of rest; and its median, which tells a fluid that
// keeps its density from one that has no excess because it has swollen.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace {

using Point = std::array<double, 3>;

struct Set {
    double radius = 0.0;
    std::vector<Point> points;
};

Set readPos(const char* name) {
    std::ifstream file(name, std::ios::binary);
    std::uint32_t count = 0;
    float radius = 0.0F;
    file.read(reinterpret_cast<char*>(&count), sizeof count);
    file.read(reinterpret_cast<char*>(&radius), sizeof radius);
    Set set{double{radius}, {}};
    std::array<float, 3> at{};
    while (set.points.size() < count && file.read(reinterpret_cast<char*>(at.data()), sizeof at)) {
        set.points.push_back({double{at[0]}, double{at[1]}, double{at[2]}});
    }
    if (set.points.size() != count || count == 0) {
        fmt::print(stderr, "{}: expected a .pos file, found {} of {} particles\n", name, set.points.size(), count);
        std::exit(1);
    }
    return set;
}

/// Up to a factor, which the volume of a particle takes out; q = distance / support.
using Kernel = double (*)(double q);

double cubicSpline(double q) {
    if (q <= 0.5) {
        return 6.0 * q * q * (q - 1.0) + 1.0;
    }
    return q < 1.0 ? 2.0 * (1.0 - q) * (1.0 - q) * (1.0 - q) : 0.0;
}

double poly6(double q) {
    const double inside = std::max(0.0, 1.0 - q * q);
    return inside * inside * inside;
}

double wendland(double q) {
    const double inside = std::max(0.0, 1.0 - q);
    return inside * inside * inside * inside * (4.0 * q + 1.0);
}

double latticeVolume(Kernel kernel, double spacing, double support) {
    double sum = 0.0;
    constexpr int kFar = 4;
    for (int x = -kFar; x <= kFar; ++x) {
        for (int y = -kFar; y <= kFar; ++y) {
            for (int z = -kFar; z <= kFar; ++z) {
                sum += kernel(spacing * std::hypot(x, y, z) / support);
            }
        }
    }
    return 1.0 / sum;
}

class Cells {
  public:
    Cells(const std::vector<Point>& points, double side) : points_(points), side_(side) {
        for (std::size_t i = 0; i < points.size(); ++i) {
            cells_[key(cellOf(points[i], {}))].push_back(i);
        }
    }
    [[nodiscard]] double sumAt(const Point& x, Kernel kernel) const {
        double sum = 0.0;
        for (int i = 0; i < 27; ++i) {
            const auto found = cells_.find(key(cellOf(x, {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1})));
            if (found == cells_.end()) {
                continue;
            }
            for (const std::size_t j : found->second) {
                const Point& y = points_[j];
                sum += kernel(std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]) / side_);
            }
        }
        return sum;
    }

  private:
    using Cell = std::array<int, 3>;
    [[nodiscard]] Cell cellOf(const Point& x, const Cell& moved) const {
        Cell cell{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            cell[axis] = static_cast<int>(std::floor(x[axis] / side_)) + moved[axis];
        }
        return cell;
    }
    /// One to one within a million cells of the origin.
    static std::int64_t key(const Cell& cell) {
        return ((std::int64_t{cell[0]} << 21U) + std::int64_t{cell[1]}) * (std::int64_t{1} << 21U) +
               std::int64_t{cell[2]};
    }

    const std::vector<Point>& points_;
    double side_;
    std::unordered_map<std::int64_t, std::vector<std::size_t>> cells_;
};

}  // namespace

int main(int argc, char** argv) {
    const std::map<std::string, std::pair<Kernel, double>> kernels{
        {"cubic", {cubicSpline, 2.0}}, {"poly6", {poly6, 2.0}}, {"wendland", {wendland, 3.0}}};
    if (argc < 7 || kernels.count(argv[1]) == 0 || !(std::strtod(argv[2], nullptr) > 0.0)) {
        fmt::print(stderr, "particle_density cubic|poly6|wendland VOLUME X Y Z FILE.pos...\n");
        return 2;
    }
    const auto [kernel, reach] = kernels.at(argv[1]);
    const double edge = std::cbrt(std::strtod(argv[2], nullptr));
    const Point high{std::strtod(argv[3], nullptr), std::strtod(argv[4], nullptr), std::strtod(argv[5], nullptr)};
    double mean = 0.0;
    double greatest = 0.0;
    double inside = 0.0;
    double spread = 0.0;
    double median = 0.0;
    const int files = argc - 6;
    for (int i = 6; i < argc; ++i) {
        const Set set = readPos(argv[i]);
        const double spacing = 2.0 * set.radius;
        const double support = reach * spacing;
        const double volume = latticeVolume(kernel, edge * spacing, support);
        const Cells cells(set.points, support);
        double over = 0.0;
        double sum = 0.0;
        double squares = 0.0;
        double counted = 1e-9;
        std::vector<double> densities;
        for (const Point& x : set.points) {
            bool away = true;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                away = away && x[axis] > support && x[axis] < high[axis] - support;
            }
            if (away) {
                const double density = volume * cells.sumAt(x, kernel);
                over += std::max(0.0, density - 1.0);
                greatest = std::max(greatest, density - 1.0);
                densities.push_back(density);
                sum += density;
                squares += density * density;
                counted += 1.0;
            }
        }
        if (!densities.empty()) {
            const auto middle = densities.begin() + static_cast<std::ptrdiff_t>(densities.size() / 2);
            std::nth_element(densities.begin(), middle, densities.end());
            median += *middle / files;
        }
        mean += over / counted / files;
        inside += counted / files;
        spread += std::sqrt(std::max(0.0, squares / counted - sum * sum / counted / counted)) / files;
    }
    fmt::print(
        "{} files, {:.0f} particles away from walls in the mean: mean {:.3f} %, greatest {:.1f} %, deviation {:.2f} %, "
        "median {:.4f}\n",
        files, inside, 100.0 * mean, 100.0 * greatest, 100.0 * spread, median);
    return 0;
}
