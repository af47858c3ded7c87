// A renderer of direct light in one file, for Lightproof: c++ -O2 -std=c++17 -o area_light area_light.cpp
//
// The irradiance of polygonal lights past polygonal blockers, at points and over the cells of a plane, by Monte Carlo over
// the lights' area. Each line of standard input is a job, each line of standard output its answer: see ../README.md.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <map>
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

struct Parser {
    const string& in;
    size_t at = 0;

    bool take(char c) {
        while (isspace((unsigned char)in.at(at))) at++;
        return in[at] == c && ++at;
    }
    string quoted() {                    // after the opening quote
        string text;
        for (; in.at(at) != '"'; at++) {
            if (in[at] == '\\' && in.at(++at) == 'u') at += 4, text += '?';  // a letter beyond ASCII: in titles only
            else text += in[at];
        }
        return at++, text;
    }
    Json value() {
        Json json;
        if (take('{')) {
            while (!take('}')) { take(','); take('"'); string key = quoted(); take(':'); json.fields[key] = value(); }
        } else if (take('[')) {
            while (!take(']')) { take(','); json.items.push_back(value()); }
        } else if (take('"')) {
            json.text = quoted();
        } else {
            size_t end = in.find_first_of(",]} ", at);
            json.text = in.substr(at, end - at), at = end;
        }
        return json;
    }
};

// ---- Geometry [m] -----------------------------------------------------------------------------------------------------
struct Vec { double x, y, z; };
Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec operator*(double s, Vec a) { return {s * a.x, s * a.y, s * a.z}; }
double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec cross(Vec a, Vec b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
double length(Vec a) { return std::sqrt(dot(a, a)); }
Vec unit(Vec a) { return (1 / length(a)) * a; }
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
            Polygon polygon = walls.emplace_back(light["shape"]);
            for (size_t i = 2; i < polygon.corners.size(); i++) {  // a fan
                Vec corner = polygon.corners[0], first = polygon.corners[i - 1] - corner, second = polygon.corners[i] - corner;
                if (dot(cross(first, second), polygon.normal) < 0) throw Unsupported("area-light samples convex lights only");
                double area = length(cross(first, second)) / 2;
                lit.push_back({corner, first, second, polygon.normal, light["radiance"].number() * area});
                power += lit.back().power;
            }
        }
        for (const Json& surface : scene["surface"].items) {
            if (surface["radiance"].number() > 0) throw Unsupported("area-light has no surfaces that glow");
            if (surface["reflectance"].number() > 0 && scene["max_bounces"].text != "0")
                throw Unsupported("area-light has no reflections");
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
    string values, variances;
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
        char number[64];
        snprintf(number, sizeof number, element ? ",%.17g" : "%.17g", mean), values += number;
        snprintf(number, sizeof number, element ? ",%.17g" : "%.17g", squares / (samples - 1) / samples), variances += number;
    }
    return "\"samples\":" + std::to_string(samples) + ",\"film\":[" + values + "],\"variance\":[" + variances + "]";
}

int main(int count, char** words) {
    if (count == 2 && string(words[1]) == "--version") return puts("area-light 1.0") < 0;
    for (string line, answer; std::getline(std::cin, line);) {
        Json job = Parser{line}.value();
        try {
            answer = render(job);
        } catch (const Unsupported& reason) {
            answer = "\"unsupported\":\"" + string(reason.what()) + "\"";
        }
        printf("{\"job\":\"%s\",\"digest\":\"%s\",%s}\n", job["job"].text.c_str(), job["digest"].text.c_str(), answer.c_str());
        fflush(stdout);
    }
}
