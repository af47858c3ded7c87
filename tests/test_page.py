"""index.html: one file, right in what it shows, harmless whatever the names, and sound in a browser without a network."""

from __future__ import annotations

import base64
import io
import json
import re
import shutil
from collections import Counter
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import small_run
from PIL import Image

from lightproof import reporting
from lightproof.method import Unavailable
from lightproof.reporting import citations, front, page, race_chart, speed_page
from lightproof.reporting.colours import LIGHT, SIGNED, film_image
from lightproof.reporting.evaluation import Evaluation, evaluate
from lightproof.reporting.families import Family, families
from lightproof.reporting.scene_view import SceneView, round_up
from lightproof.verdict import Outcome


def picture(scene) -> bytes:
    """A stand-in for the rendered set-up; the camera's scene has none."""
    if scene.id == "view":
        raise Unavailable("Mitsuba <3> is missing; pip install 'lightproof[mitsuba]'")
    buffer = io.BytesIO()
    Image.new("RGB", (80, 50), "tan").save(buffer, "PNG")
    return buffer.getvalue()


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return small_run.make(tmp_path_factory.mktemp("page"))


@pytest.fixture(scope="module")
def evaluation(run) -> Evaluation:
    return evaluate(*run)


@pytest.fixture(scope="module")
def html(run, evaluation) -> str:
    return page.render(evaluation, citations.read(run[1].root / "references" / "references.bib"), picture)


def view(evaluation: Evaluation, scene: str) -> SceneView:
    cells = [cell for cell in evaluation.cells if cell.scene.id == scene]
    return SceneView(cells[0].scene, cells, evaluation.methods, "", "", {})


def pixels(uri: str) -> np.ndarray:
    """The image of a data URI as (rows, columns, 3) bytes."""
    return np.asarray(Image.open(io.BytesIO(base64.b64decode(uri.partition(",")[2]))).convert("RGB"))


def test_the_page_says_what_came_out(html):
    """Of three scenes: exact, unbiased, hostile-named and biased methods pass, pi fails, a crash and a refusal each."""
    assert "In 12 of 15 judged cases the light is right, in 3 it is wrong; 3 unsupported, 3 ended in an error." in html


@pytest.mark.parametrize(("counts", "said"), [
    ({Outcome.PASS: 2}, "In 2 of 2 judged cases the light is right."),
    ({Outcome.PASS: 1, Outcome.UNDECIDED: 3}, "In 1 of 4 judged cases the light is right, in 3 it is undecided."),
    ({Outcome.UNSUPPORTED: 2}, "Nothing could be judged: 2 unsupported."),
    ({}, "Nothing could be judged: the run is empty."),
])
def test_the_answer_in_one_sentence(counts, said):
    assert page.answer(Counter(counts)) == said


def test_findings_are_the_wrong_the_broken_and_the_biased_in_this_order(evaluation):
    """mc-cosine fails, cycles crashes, path is 0.4 % too bright within a tolerance of 1 %; nothing else is a finding."""
    found = [cell.method for cell in page.findings(evaluation)]
    assert found == 3 * ["mc-cosine"] + 3 * ["cycles"] + 3 * ["path"]


def test_columns_are_a_readers_own_then_ours_then_the_renderers():
    """Each renderer with all its configurations, all of ours as one."""
    columns = families(["mine:Mine", "mitsuba", "mitsuba/scalar", "cycles", "analytic", "mc-area"])
    counts = {column.name: len(column.methods) for column in columns}
    assert list(counts.items()) == [("mine:Mine", 1), ("ours", 2), ("mitsuba", 2), ("cycles", 1)]


def test_the_best_of_a_family(evaluation):
    """analytic is exact at once, mc-area has noise, mc-cosine is wrong; of crashed and refused ones whatever there is."""
    scene = evaluation.scenes[0]

    def best(*methods: str) -> str:
        return Family("any", methods).best(evaluation, scene).method

    assert best("mc-cosine", "mc-area", "analytic") == "analytic"
    assert best("mc-cosine", "mc-area") == "mc-area"
    assert best("cycles", "mc-cosine") == "mc-cosine"
    assert best("pyrender", "cycles") == "cycles"
    assert Family("any", ("luxcore",)).best(evaluation, scene) is None


def test_what_no_finite_run_excludes_is_said_once(html):
    assert html.count("rare events") == 1


def test_what_triangles_change_stands_beside_the_verdict(html):
    """path has triangles that change 2e-4 of the scale, mc-cosine some of unknown effect, the other methods none."""
    said = {"path": "; triangles in the place of round shapes change an element by at most 0.020 %",
            "mc-cosine": "; what triangles in the place of round shapes change is not known", "mc-area": None}  # fmt: skip
    reasons = re.findall(r"<p><strong>([a-z-]+)</strong> on <a.*?</a></p>\s*<p>(.*?)</p>", html)
    for method, sentence in said.items():
        of_method = [reason for name, reason in reasons if name == method]
        assert of_method and all(reason.endswith(sentence) if sentence else "triangles" not in reason for reason in of_method)


def test_unsupported_is_grey_and_says_why(html):
    """Every badge that says unsupported has that class and no other; its reason stands in the matrix and by the films."""
    badges = re.findall(r'class="badge ([a-z-]+)"><span aria-hidden="true">.</span> ([a-z ]+)', html)
    assert {outcome for outcome, word in badges if word.startswith("unsupported")} == {"unsupported"}
    assert {outcome for outcome, word in badges if word.startswith("pass")} == {"pass"}
    assert html.count(f"<p>{small_run.REFUSAL}</p>") == 2 * 3  # by family, and of every method
    assert html.count(f"<span>{small_run.REFUSAL}</span>") == 3


def test_every_file_is_inside(html):
    """No image, script or style from elsewhere, and a policy that forbids the browser to ask for one."""
    markup = re.sub(r"<script>.*?</script>", "", html, flags=re.DOTALL)
    assert all(source.startswith("data:") for source in re.findall(r'src="([^"]*)"', markup))
    assert not re.search(r"<link(?! rel=\"icon\" href=\"data:,\")|<iframe|@import|url\(", markup)
    assert "default-src 'none'" in markup


def test_foreign_names_and_messages_are_text(html):
    """A method named as an image tag, a title with markup, a crash message with an escape sequence."""
    assert "<img src=x" not in html and "<em>" not in html and "<script>window" not in html
    assert html.isprintable() or not set(html) & {"\x1b", "\u202e", "\udcff"}
    assert "&lt;em&gt;&amp; more&lt;/em&gt;" in html and "\\x1b[31m&lt;script&gt;" in html


def test_a_picture_that_cannot_be_made_is_explained(html):
    assert "No picture of the set-up: Mitsuba &lt;3&gt; is missing; pip install &#39;lightproof[mitsuba]&#39;" in html


def test_sources_are_resolved(html):
    """The reference names its source and cites ramp2026, which the bibliography knows with a DOI."""
    assert '<a href="https://doi.org/10.1000/1" rel="noreferrer">Ada Ramp and Bo Slope. On &lt;ramps&gt;. 2026</a>' in html
    assert "<dd>a ramp</dd>" in html


def test_a_missing_bibliography_is_no_error(tmp_path):
    assert citations.read(tmp_path / "references.bib") == {}


def test_a_plane_film_has_its_first_row_at_the_bottom(evaluation):
    """Light rises along the rows: a plane film is brightest on top, a camera image at the bottom."""
    assert pixels(view(evaluation, "floor").exact).sum(axis=2).mean(axis=1).argmax() == 0
    assert pixels(view(evaluation, "view").exact).sum(axis=2).mean(axis=1).argmax() == 5


def test_colours_are_the_map_s_at_both_ends_and_beyond():
    """Below, at and above a scale from 0 to 1."""
    film = small_run.scene("spots").film
    ends = pixels(film_image(np.array([-3.0, 7.0]), film, LIGHT, 0.0, 1.0))[0]
    assert [bytes(colour).hex() for colour in ends] == [LIGHT.anchors[0], LIGHT.anchors[-1]]


def test_all_methods_of_a_scene_share_one_scale(evaluation):
    """The exact film shows no error, one pi times too bright the end of the scale; errors are drawn to twice the tolerance."""
    of_scene = view(evaluation, "floor")
    error = {cell.method: pixels(of_scene.images(cell)[1]) for cell in of_scene.measured}
    assert (error["analytic"] == SIGNED.palette[127]).all()
    assert (error["mc-cosine"] == SIGNED.palette[-1]).all()
    assert [(bar.low, bar.high) for bar in of_scene.bars] == [(0.0, 1.0), (-2.0, 2.0), (-4.0, 4.0)]


def test_errors_in_standard_errors_need_noise(evaluation):
    """Sixteen noisy films have a third image, an exact single one has not; the noisy ones' errors are about one."""
    cells = {cell.method: cell for cell in evaluation.cells if cell.scene.id == "floor"}
    assert cells["analytic"].z_score is None
    assert len(view(evaluation, "floor").images(cells["analytic"])) == 2
    assert np.std(cells["mc-area"].z_score) == pytest.approx(1, abs=0.3)


def test_the_standard_error_is_that_of_the_mean(evaluation):
    """Two films, 1 and 3 everywhere: mean 2, standard deviation sqrt(2), standard error 1."""
    cell = next(cell for cell in evaluation.cells if (cell.scene.id, cell.method) == ("spots", "mc-area"))
    two = tuple(replace(result, film=np.full(2, value)) for result, value in zip(cell.results[:2], (1.0, 3.0), strict=True))
    assert replace(cell, results=two).film == pytest.approx([2.0, 2.0])
    assert replace(cell, results=two).standard_error == pytest.approx([1.0, 1.0])


def test_a_certain_value_that_is_off_is_infinitely_many_standard_errors_off(evaluation):
    """Two elements: one right and one wrong without noise, in a film whose replicates differ elsewhere."""
    cell = next(cell for cell in evaluation.cells if (cell.scene.id, cell.method) == ("spots", "mc-area"))
    certain = replace(cell, results=tuple(replace(result, film=np.array([result.film[0], 0.75])) for result in cell.results))
    assert np.isfinite(certain.z_score[0]) and certain.z_score[1] == -np.inf


def test_the_chart_has_a_point_for_each_step_and_a_line_at_the_tolerance(evaluation):
    """Five methods, four steps; what is below the floor is drawn on it."""
    cells = [cell for cell in evaluation.cells if cell.scene.id == "floor"]
    chart = race_chart.error_against_time(cells, evaluation.methods, 0.01)
    tolerance, fronts, points = sorted(chart["datasets"].values(), key=len)
    assert tolerance == [{"error": 1.0, "text": "tolerance 1 %"}]
    assert Counter(point["method"] for point in points)["mc-area"] == 4
    assert min(point["error"] for point in points) == pytest.approx(100 * front.FLOOR)
    assert {corner["front"] for corner in fronts} == {front.ALL, front.SAMPLING, front.EXTERNAL}
    assert race_chart.error_against_time([], evaluation.methods, 0.01) is None


@pytest.mark.parametrize(("value", "end"), [(0.97, 1.0), (1.0, 1.0), (1.01, 1.2), (83.0, 100.0), (0.0, 1.0), (3e-7, 3e-7)])
def test_scales_end_at_round_numbers(value, end):
    assert round_up(value) == pytest.approx(end)


def interrupted(record, suite, trials: int) -> Evaluation:
    """The run as a kill after some trials would have left it."""
    return evaluate(SimpleNamespace(run=record.run, scenes=record.scenes, results=lambda: record.results()[:trials]), suite)


@pytest.mark.parametrize(("trials", "said"), [
    (0, "Nothing could be judged: the run is empty."),
    (5, "In 1 of 2 judged cases the light is right, in 1 it is undecided."),
])
def test_a_run_cut_short_has_a_page(run, trials, said):
    """After no trial, and after the exact method's four films and the first of sixteen of mc-area: all three scenes are there."""
    html = page.render(interrupted(*run, trials), {}, picture)
    assert said in html
    assert [f"The {scene.id} " in html for scene in small_run.SCENES] == [True, True, True]


def test_an_unfinished_step_does_not_speak_for_the_method(run):
    """mc-area killed in its second step, after three of sixteen films: the first step's film and bias are shown."""
    cell = interrupted(*run, 4 + 16 + 3).cells[1]
    assert (len(cell.final), cell.step.samples, cell.step.replicates) == (16, 64, 16)
    assert len(cell.verdict.steps) == 2


def test_write_leaves_four_files_in_the_run(run, monkeypatch):
    """Both pages and both tables, in the run's own folder."""
    from lightproof.reporting import pictures

    monkeypatch.setattr(pictures, "picture", lambda scene, cache_folder: picture(scene))
    record, suite = run
    path = reporting.write(record.folder, suite)
    assert path == record.folder / "index.html"
    assert {"results.csv", "summary.csv", "index.html", "speed.html"} <= {file.name for file in record.folder.iterdir()}


MARKS = "(chart) => chart.querySelectorAll('.mark-symbol.role-mark path').length"


@pytest.fixture(scope="module")
def browser():
    """Headless Chromium that logs what the page says and what it asks the network for."""
    from selenium import webdriver

    chromium, driver = (shutil.which(name) for name in ("chromium", "chromedriver"))
    if not chromium or not driver:
        pytest.skip("Chromium is not installed; apt-get install chromium chromium-driver")
    options = webdriver.ChromeOptions()
    options.binary_location = chromium
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    browser = webdriver.Chrome(options=options, service=webdriver.ChromeService(driver))
    yield browser
    browser.quit()


@pytest.fixture(scope="module")
def opened(browser, html, tmp_path_factory):
    """The page on a phone 390 pixels wide, with all its charts drawn."""
    from selenium.webdriver.support.wait import WebDriverWait

    path = tmp_path_factory.mktemp("browser") / "index.html"
    path.write_text(html, encoding="utf-8")
    phone = {"width": 390, "height": 844, "deviceScaleFactor": 1, "mobile": True}
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", phone)
    browser.get(path.as_uri())
    drawn = "return [...document.querySelectorAll('.chart')].every((chart) => chart.querySelector('svg'))"
    WebDriverWait(browser, 30).until(lambda page: page.execute_script(drawn))
    return browser


@pytest.fixture(scope="module")
def speed_opened(opened, evaluation, tmp_path_factory):
    """The speed page on the same phone, scrolled to every chart in turn, so that all are drawn."""
    from selenium.webdriver.support.wait import WebDriverWait

    views = speed_page.views(evaluation)
    path = tmp_path_factory.mktemp("browser") / "speed.html"
    path.write_text(speed_page.render(views, evaluation, page.environment(), page.bundle()), encoding="utf-8")
    opened.get(path.as_uri())
    scroll = "const left = [...document.querySelectorAll('.chart')].find((chart) => !chart.querySelector('svg'));" \
             "left?.scrollIntoView(); return !left"
    WebDriverWait(opened, 60).until(lambda page: page.execute_script(scroll))
    return opened


def test_the_browser_reports_no_error(opened):
    assert opened.get_log("browser") == []
    assert opened.execute_script("return window.hacked") is None


def test_every_chart_has_a_mark_for_each_measurement(opened):
    """Cost: four passing methods (one of them biased) on three scenes."""
    assert opened.execute_script(f"return [...document.querySelectorAll('.chart')].map({MARKS})")[:1] == [12]


def test_the_browser_asks_the_network_for_nothing(opened):
    """The page itself is all that is fetched."""
    events = [json.loads(entry["message"])["message"] for entry in opened.get_log("performance")]
    asked = [event["params"]["request"]["url"] for event in events if event["method"] == "Network.requestWillBeSent"]
    assert {url.partition(":")[0] for url in asked} <= {"file", "data"} and sum(url.startswith("file") for url in asked) == 1


def test_every_picture_is_there(opened):
    """Two pictures of a set-up, two exact films, and for five methods three images (the exact one: two) on two scenes."""
    widths = opened.execute_script("return [...document.images].map((image) => image.naturalWidth)")
    assert len(widths) == 2 + 2 + 2 * (4 * 3 + 2)
    assert all(width > 0 for width in widths)


def test_the_page_is_no_wider_than_a_phone(opened):
    assert opened.execute_script("return document.documentElement.scrollWidth") == 390


def test_a_tap_on_a_verdict_shows_its_reason(opened):
    """The refusal of pyrender is hidden until its badge is pressed."""
    shown = "return [...document.querySelectorAll('.why:popover-open')].map((box) => box.innerText)"
    assert opened.execute_script(shown) == []
    opened.execute_script("document.querySelector('.matrix button:has(.unsupported)').click()")
    assert small_run.REFUSAL in opened.execute_script(shown)[0]


def test_the_speed_page_is_sound_on_a_phone(speed_opened):
    """After all other tests of the browser: no error, nothing from the network, no wider than the screen."""
    assert speed_opened.get_log("browser") == []
    assert speed_opened.execute_script("return window.hacked") is None
    assert speed_opened.execute_script("return document.documentElement.scrollWidth") == 390


def test_every_chart_of_speed_has_its_marks(speed_opened):
    """A scene: five methods of four steps; four right methods at 1 %, analytic alone at 0.1 % and 0.01 % too; bars; the slopes of
    the three that have an error."""
    assert speed_opened.execute_script(f"return [...document.querySelectorAll('.chart')].map({MARKS})") == 3 * [20, 6, 0, 3]
    bars = "document.querySelectorAll('.rows > div:nth-child(2) .mark-rect path').length"
    assert speed_opened.execute_script(f"return {bars}") == 3 * 3
