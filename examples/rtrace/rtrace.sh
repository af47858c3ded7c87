#!/bin/sh
# Radiance's rtrace as a renderer for Lightproof: `rtrace.sh JOB.json`, once for each job (see ../README.md).
# It needs jq and awk, and oconv and rtrace on the PATH: those that `pip install pyradiance` brings are found with
# PATH="$(python -c 'import pyradiance; print(*pyradiance.__path__)')/bin:$PATH"
#
# Irradiance of rectangular lights past polygonal blockers, over the cells of a plane and at points. rtrace takes no seed, so
# nothing in it is left to chance: a light is up to 8 x 8 lights at fixed places, which costs about a part in a thousand. The
# seed draws `samples` points in each cell of a plane; a point of a points film is one sample.
set -eu
lib=$(dirname "$(command -v rtrace)")/../lib
export RAYPATH="${RAYPATH:-.:$lib}"

if [ "$1" = --version ]; then
    exec rtrace -version
fi
job=$1
cd "$(dirname "$job")"   # the job's own folder: whatever is left here is deleted

reason=$(jq -r '
    def minus($a; $b): [range(3) | $a[.] - $b[.]];
    def dot($a; $b): [range(3) | $a[.] * $b[.]] | add;
    def is_zero: fabs < 1e-9;
    def is_rectangle: .type == "polygon" and (.vertices | length == 4
        and (dot(minus(.[1]; .[0]); minus(.[3]; .[0])) | is_zero)
        and (minus(minus(.[2]; .[1]); minus(.[3]; .[0])) | all(.[]; is_zero)));
    .scene | if .film.quantity != "irradiance" or (.film.kind != "plane" and .film.kind != "points")
        then "rtrace.sh gives irradiance, over a plane or at points"
    elif any(.light[]; .kind != "area" or (.shape | is_rectangle | not)) then "rtrace.sh has rectangular lights only"
    elif any(.surface[]; .shape.type != "polygon" or .radiance > 0) then "rtrace.sh has no surfaces but polygons that are dark"
    elif .max_bounces != 0 and any(.surface[]; .reflectance > 0) then "rtrace.sh follows no reflections"
    else empty end' "$job")
if [ -n "$reason" ]; then
    jq -c --arg reason "$reason" '{job, digest, unsupported: $reason}' "$job"
    exit
fi

jq -r '
    def polygon($material): "\($material) polygon \(.id) 0 0 \(.shape.vertices | 3 * length) \([.shape.vertices[][]] | join(" "))";
    .scene | (.light[] | "void light \(.id)-on 0 0 3 \(.radiance) \(.radiance) \(.radiance)", polygon("\(.id)-on")),
             "void plastic black 0 0 5 0 0 0 0 0", (.surface[] | polygon("black"))' "$job" > scene.rad
oconv scene.rad > scene.oct

if [ "$(jq -r .scene.film.kind "$job")" = plane ]; then
    samples=$(jq .samples "$job")
    jq -r '[.seed, .samples, .film.rows, .film.columns, (.scene.film | .origin[], .u[], .v[])] | join(" ")' "$job" | awk '{
        srand($1 + 0)   # mawk takes a word as it takes nothing
        nx = $9 * $13 - $10 * $12; ny = $10 * $11 - $8 * $13; nz = $8 * $12 - $9 * $11
        for (row = 0; row < $3; row++) for (column = 0; column < $4; column++) for (n = 0; n < $2; n++) {
            a = (column + rand()) / $4; b = (row + rand()) / $3
            printf "%.9g %.9g %.9g %.9g %.9g %.9g\n", $5 + a*$8 + b*$11, $6 + a*$9 + b*$12, $7 + a*$10 + b*$13, nx, ny, nz
        }
    }'
else
    samples=1
    jq -r '.scene.film | [.positions, .normals] | transpose[] | flatten | join(" ")' "$job"
fi > points

# rtrace -I looks from 1e-4 above the point that it is given.
awk '{ n = 1e4 * sqrt($4*$4 + $5*$5 + $6*$6); print $1 - $4/n, $2 - $5/n, $3 - $6/n, $4, $5, $6 }' OFMT=%.12g points |
    rtrace -h- -I+ -ab 0 -dt 0 -dc 1 -dj 0 -ds .1 -lw 0 scene.oct |
    awk -v samples="$samples" '{ sum += $1 } NR % samples == 0 { printf "%.9g\n", sum / samples; sum = 0 }' > film

jq -c --argjson samples "$samples" --slurpfile film film '{job, digest, samples: $samples, film: $film}' "$job"
