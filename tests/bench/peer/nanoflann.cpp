// The registration of `ch16 register` on nanoflann's k-d tree, for the table of the benchmark:
// the same files, increments and rule for stopping; only who finds the nearest neighbour differs.
//
//   nanoflann MAP.csv SCAN.csv p2l|p2p TAU REPEATS
//
// prints one JSON object: nanoflann's version, pose, iterations, and the fastest registration and build in µs of CPU time.

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <nanoflann.hpp>

namespace {

constexpr int kMaxIterations = 25;
constexpr std::size_t kMinPairs = 8;
constexpr double kTolerance = 1e-4;

struct Point {
  double x, y, nx, ny;
};

struct Cloud {
  std::vector<Point> points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t index, std::size_t axis) const {
    return axis == 0 ? points[index].x : points[index].y;
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 2, std::size_t>;

struct Pose {
  double x = 0, y = 0, theta = 0;
};

struct Pair {
  double px, py;
  const Point* target;
};

Cloud read(const char* path) {
  std::ifstream file(path);
  if (!file) {
    std::fprintf(stderr, "%s: cannot be read\n", path);
    std::exit(2);
  }
  Cloud cloud;
  for (std::string line; std::getline(file, line);) {
    for (char& c : line) c = c == ',' ? ' ' : c;
    std::istringstream numbers(line);
    Point point{};
    numbers >> point.x >> point.y >> point.nx >> point.ny;
    cloud.points.push_back(point);
  }
  return cloud;
}

Pose compose(const Pose& a, const Pose& b) {
  const double c = std::cos(a.theta), s = std::sin(a.theta);
  return {a.x + c * b.x - s * b.y, a.y + s * b.x + c * b.y,
          std::remainder(a.theta + b.theta, 2 * M_PI)};
}

/// ‖(vx, vy)‖ + |omega| of the logarithm.
double step_size(const Pose& step) {
  const double half = 0.5 * step.theta;
  const double a = std::abs(step.theta) < 1e-4 ? 1 - half * half / 3 : half / std::tan(half);
  return std::hypot(a * step.x + half * step.y, a * step.y - half * step.x) + std::abs(step.theta);
}

/// The rotation by theta about one point, then the way to another.
Pose about(double fx, double fy, double tx, double ty, double theta) {
  const double c = std::cos(theta), s = std::sin(theta);
  return {tx - (c * fx - s * fy), ty - (s * fx + c * fy), theta};
}

void associate(const Cloud& scan, const Cloud& map, const Tree& tree, const Pose& pose, double tau,
               std::vector<Pair>& pairs) {
  const double c = std::cos(pose.theta), s = std::sin(pose.theta);
  pairs.clear();
  for (const Point& p : scan.points) {
    const double query[2] = {c * p.x - s * p.y + pose.x, s * p.x + c * p.y + pose.y};
    std::size_t index = 0;
    double squared = 0;
    nanoflann::KNNResultSet<double, std::size_t> nearest(1);
    nearest.init(&index, &squared);
    // Nothing farther than tau is of interest: the search may leave it out.
    squared = tau * tau;
    tree.findNeighbors(nearest, query, {});
    if (nearest.size() > 0) pairs.push_back({query[0], query[1], &map.points[index]});
  }
}

Pose point_to_point(const std::vector<Pair>& pairs) {
  double px = 0, py = 0, qx = 0, qy = 0, dot = 0, cross = 0;
  for (const Pair& p : pairs) {
    px += p.px;
    py += p.py;
    qx += p.target->x;
    qy += p.target->y;
  }
  const double n = static_cast<double>(pairs.size());
  px /= n, py /= n, qx /= n, qy /= n;
  for (const Pair& p : pairs) {
    const double ax = p.px - px, ay = p.py - py, bx = p.target->x - qx, by = p.target->y - qy;
    dot += ax * bx + ay * by;
    cross += ax * by - ay * bx;
  }
  return about(px, py, qx, qy, std::atan2(cross, dot));
}

Pose point_to_plane(const std::vector<Pair>& pairs) {
  double cx = 0, cy = 0, n = 0;
  const auto has_normal = [](const Pair& p) { return p.target->nx != 0 || p.target->ny != 0; };
  for (const Pair& p : pairs) {
    if (!has_normal(p)) continue;
    cx += p.px;
    cy += p.py;
    n += 1;
  }
  if (n < 3) return {};
  cx /= n, cy /= n;
  double h[3][3] = {}, g[3] = {};
  for (const Pair& p : pairs) {
    if (!has_normal(p)) continue;
    const double nx = p.target->nx, ny = p.target->ny;
    const double row[3] = {nx, ny, (p.px - cx) * ny - (p.py - cy) * nx};
    const double residual = nx * (p.px - p.target->x) + ny * (p.py - p.target->y);
    for (int i = 0; i < 3; ++i) {
      g[i] -= row[i] * residual;
      for (int j = 0; j <= i; ++j) h[i][j] += row[i] * row[j];
    }
  }
  const double ridge = 1e-4 * (h[0][0] + h[1][1] + h[2][2]) / 3 + 1e-12;
  for (int i = 0; i < 3; ++i) h[i][i] += ridge;
  // Cholesky in the lower triangle, then both substitutions in g.
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j) {
      for (int k = 0; k < j; ++k) h[i][j] -= h[i][k] * h[j][k];
      h[i][j] = i == j ? std::sqrt(h[i][i]) : h[i][j] / h[j][j];
    }
  }
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < i; ++k) g[i] -= h[i][k] * g[k];
    g[i] /= h[i][i];
  }
  for (int i = 2; i >= 0; --i) {
    for (int k = i + 1; k < 3; ++k) g[i] -= h[k][i] * g[k];
    g[i] /= h[i][i];
  }
  return about(cx, cy, cx + g[0], cy + g[1], g[2]);
}

struct Found {
  Pose pose;
  int iterations = 0;
};

Found icp(const Cloud& scan, const Cloud& map, const Tree& tree, bool planes, double tau,
          std::vector<Pair>& pairs) {
  Found found;
  associate(scan, map, tree, found.pose, tau, pairs);
  while (found.iterations < kMaxIterations && pairs.size() >= kMinPairs) {
    const Pose step = planes ? point_to_plane(pairs) : point_to_point(pairs);
    found.pose = compose(step, found.pose);
    associate(scan, map, tree, found.pose, tau, pairs);
    ++found.iterations;
    if (step_size(step) < kTolerance) break;
  }
  return found;
}

double cpu_us() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

template <class Call>
double fastest_us(int repeats, Call call) {
  double fastest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < repeats; ++k) {
    const double start = cpu_us();
    call();
    fastest = std::min(fastest, cpu_us() - start);
  }
  return fastest;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) {
    std::fprintf(stderr, "nanoflann MAP.csv SCAN.csv p2l|p2p TAU REPEATS\n");
    return 2;
  }
  const Cloud map = read(argv[1]), scan = read(argv[2]);
  const bool planes = std::string(argv[3]) == "p2l";
  const double tau = std::atof(argv[4]);
  const int repeats = std::atoi(argv[5]);
  const double us_build = fastest_us(repeats, [&] { Tree built(2, map); });
  const Tree tree(2, map);
  std::vector<Pair> pairs;
  Found found;
  const double us = fastest_us(repeats, [&] { found = icp(scan, map, tree, planes, tau, pairs); });
  std::printf("{\"version\":\"%d.%d.%d\",", NANOFLANN_VERSION >> 8, NANOFLANN_VERSION >> 4 & 15,
              NANOFLANN_VERSION & 15);
  std::printf("\"pose\":[%.17g,%.17g,%.17g],\"iterations\":%d,\"us\":%.3f,\"us_build\":%.3f}\n",
              found.pose.x, found.pose.y, found.pose.theta, found.iterations, us, us_build);
}
