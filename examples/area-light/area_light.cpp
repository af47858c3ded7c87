// A renderer of direct light in one file, for Lightproof: c++ -O2 -std=c++17 -o area_light area_light.cpp
//
// The irradiance of polygonal lights past polygonal blockers, at points and over the cells of a plane, by Monte Carlo over
// the lights' area. Each line of standard input is a job, each line of standard output its answer: see ../README.md.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

using std::string, std::vector;

struct Unsupported : std::runtime_error { using runtime_error::runtime_error; };

// ---- JSON, as much of it as a job needs -------------------------------------------------------------------------------
struct Json {
    string text;                         // of a string or a number
    vector<Json> items;
    std::map<string, Json> fields;
    double number() const { return std::stod(text); }
    const Json& operator[](const string& key) const { return fields.at(key); }
};

string quoted(std::istream& in) {        // after the opening quote; escaped letters are in titles only, and stay as they are
    string text;
    for (char c; in.get(c) && c != '"';) text += c == '\\' ? char(in.get()) : c;
    return text;
}

Json parse(std::istream& in) {
    Json json;
    char c = 0;
    in >> c;
    if (c == '{') {
        while (in >> c && c != '}')      // or a comma, or the quote of a key
            if (c == '"') { string key = quoted(in); in >> c, json.fields[key] = parse(in); }
    } else if (c == '[') {
        while (in >> c && c != ']')
            if (c != ',') in.putback(c), json.items.push_back(parse(in));
    } else if (c == '"') {
        json.text = quoted(in);
    } else {
        for (in.putback(c); in.get(c) && !strchr(",]} ", c);) json.text += c;
        in.putback(c);
    }
    return json;
}

// ---- Geometry [m] -----------------------------------------------------------------------------------------------------
struct Vec { double x, y, z; };
Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec operator*(double s, Vec a) { return {s * a.x, s * a.y, s * a.z}; }
double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec cross(Vec a, Vec b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
Vec unit(Vec a) { return (1 / std::sqrt(dot(a, a))) * a; }
Vec vec(const Json& json) { return {json.items.at(0).number(), json.items.at(1).number(), json.items.at(2).number()}; }

struct Polygon {
    vector<Vec> corners;
    Vec normal{0, 0, 0};                 // of the front: the side from which the corners run counter-clockwise

    explicit Polygon(const Json& shape) {
        if (shape["type"].text != "polygon") throw Unsupported("area-light knows polygons only");
        for (const Json& corner : shape["vertices"].items) corners.push_back(vec(corner));
        for (size_t i = 2; i < corners.size(); i++)
            normal = normal + cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
        normal = unit(normal);
    }
    bool blocks(Vec from, Vec way) const {  // whether it lies across the way; what touches an end of it does not
        double t = dot(corners[0] - from, normal) / dot(way, normal);
        if (!(t > 1e-9 && t < 1 - 1e-9)) return false;
        Vec hit = from + t * way, u = unit(corners[1] - corners[0]), v = cross(normal, u);
        bool inside = false;             // whether a ray along u crosses an odd number of edges
        for (size_t i = 0; i < corners.size(); i++) {
            Vec a = corners[i] - hit, b = corners[(i + 1) % corners.size()] - hit;
            double ax = dot(a, u), ay = dot(a, v), bx = dot(b, u), by = dot(b, v);
            if ((ay > 0) != (by > 0) && ax - ay * (bx - ax) / (by - ay) > 0) inside = !inside;
        }
        return inside;
    }
};

// ---- Light ------------------------------------------------------------------------------------------------------------
struct Triangle { Vec corner, first, second, normal; double power; };  // power: radiance times area [W/sr]

struct Scene {
    vector<Triangle> lit;
    vector<Polygon> walls;               // what blocks, lights too
    double power = 0;

    explicit Scene(const Json& scene) {
        for (const Json& light : scene["light"].items) {
            if (light["kind"].text != "area") throw Unsupported("area-light has area lights only");
            const Polygon& polygon = walls.emplace_back(light["shape"]);
            for (size_t i = 2; i < polygon.corners.size(); i++) {  // a fan
                Vec corner = polygon.corners[0], first = polygon.corners[i - 1] - corner, second = polygon.corners[i] - corner;
                double area = dot(cross(first, second), polygon.normal) / 2;
                if (area < 0) throw Unsupported("area-light samples convex lights only");
                lit.push_back({corner, first, second, polygon.normal, light["radiance"].number() * area});
                power += lit.back().power;
            }
        }
        for (const Json& surface : scene["surface"].items) {
            bool reflects = surface["reflectance"].number() > 0 && scene["max_bounces"].text != "0";
            if (reflects || surface["radiance"].number() > 0) throw Unsupported("area-light has no surfaces that shine");
            walls.emplace_back(surface["shape"]);
        }
    }
};

struct Random {                          // SplitMix64 (Steele, Lea and Flood 2014)
    uint64_t state;
    uint64_t bits() {
        uint64_t z = state += 0x9e3779b97f4a7c15;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9, z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
        return z ^ (z >> 31);
    }
    double operator()() { return (bits() >> 11) * 0x1p-53; }
};

// One estimate [W/m2]: L cos cos / r2 from a random point of the lights, over the density of such points, power / L.
double sample(const Scene& scene, Vec point, Vec normal, Random& random) {
    if (scene.lit.empty()) return 0;
    const Triangle* lit = scene.lit.data();  // chosen in proportion to power
    for (double left = random() * scene.power; lit < &scene.lit.back() && left >= lit->power; lit++) left -= lit->power;
    double a = std::sqrt(random()), b = a * random();
    Vec way = lit->corner + (a - b) * lit->first + b * lit->second - point;
    double square = dot(way, way), here = dot(way, normal), there = -dot(way, lit->normal);
    if (here <= 0 || there <= 0) return 0;
    for (const Polygon& wall : scene.walls)
        if (wall.blocks(point, way)) return 0;
    return scene.power * here * there / (square * square);
}

string render(const Json& job) {
    const Json& film = job["scene"]["film"];
    bool plane = film["kind"].text == "plane";
    if (film["quantity"].text != "irradiance" || (!plane && film["kind"].text != "points"))
        throw Unsupported("area-light gives irradiance, over a plane or at points");
    Scene scene(job["scene"]);
    long rows = std::stol(job["film"]["rows"].text), columns = std::stol(job["film"]["columns"].text);
    long samples = std::max(2L, std::stol(job["samples"].text));  // a variance needs two
    uint64_t seed = Random{std::stoull(job["seed"].text)}.bits();
    std::ostringstream values, variances;
    values.precision(17), variances.precision(17);
    for (long element = 0; element < rows * columns; element++) {
        Random random{seed ^ Random{uint64_t(element)}.bits()};
        Vec origin = vec(plane ? film["origin"] : film["positions"].items.at(element)), u{0, 0, 0}, v{0, 0, 0};
        if (plane) u = vec(film["u"]), v = vec(film["v"]);
        Vec normal = unit(plane ? cross(u, v) : vec(film["normals"].items.at(element)));
        double mean = 0, squares = 0;    // of the deviations from it (Welford 1962)
        for (long n = 1; n <= samples; n++) {
            double across = (element % columns + random()) / columns, along = (element / columns + random()) / rows;
            double value = sample(scene, origin + across * u + along * v, normal, random), step = value - mean;
            mean += step / n;
            squares += step * (value - mean);
        }
        const char* comma = element ? "," : "";
        values << comma << mean, variances << comma << squares / (samples - 1) / samples;
    }
    return "\"samples\":" + std::to_string(samples) + ",\"film\":[" + values.str() + "],\"variance\":[" + variances.str() + "]";
}

int main(int count, char** words) {
    if (count == 2 && string(words[1]) == "--version") return puts("area-light 1.0") < 0;
    for (string line, answer; std::getline(std::cin, line);) {
        std::istringstream in(line);
        Json job = parse(in);
        string about = "{\"job\":\"" + job["job"].text + "\",\"digest\":\"" + job["digest"].text + "\",";
        try {
            answer = render(job);
        } catch (const Unsupported& reason) {
            answer = "\"unsupported\":\"" + string(reason.what()) + "\"";
        }
        std::cout << about << answer << "}" << std::endl;
    }
}
