"""Tries a page that plays a motion in headless Chromium: check.py PAGE [PICTURES]

runtime/plot/check runs it. PAGE is that of the tests of clebsch-plot: a point on a circle of radius 2 about (1, 0, 0), once
round in 4 s, and bodies that turn with it.
"""

import importlib.util
import math
import pathlib
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]

# how long the page plays before it is looked at, s
PLAYED = 1.5
# a picture has at least this share of its pixels drawn
LEAST_INK = 0.02

# where the page draws a point of space, by the angles that it reports: the third axis is up
PLACE = """
const [x, y, z] = arguments;
const { azimuth, elevation, zoom } = document.documentElement.dataset;
const [a, e] = [Number(azimuth), Number(elevation)];
const canvas = document.querySelector("canvas");
const [width, height] = [canvas.clientWidth, canvas.clientHeight];
const scale = Math.min(width, height) / 2 * 0.88 * Number(zoom);
const right = Math.cos(a) * x + Math.sin(a) * y;
const up = Math.cos(e) * z + Math.sin(e) * (Math.cos(a) * y - Math.sin(a) * x);
const [across, down] = [width / 2 + scale * right, height / 2 - scale * up];
const pixels = canvas.width / width;
return [...canvas.getContext("2d").getImageData(Math.round(across * pixels), Math.round(down * pixels), 1, 1).data];
"""

INK = """
const canvas = document.querySelector("canvas");
const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
let drawn = 0;
for (let i = 3; i < data.length; i += 4) {
    drawn += data[i] > 0;
}
return drawn / (canvas.width * canvas.height);
"""


def browser_of_live_pages():
    """The session of ChromeDriver that the check of the live pages has."""
    path = ROOT / "docs/book/live/check.py"
    spec = importlib.util.spec_from_file_location("live", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.Browser


class Page:
    """The page with the results of its checks."""

    def __init__(self, browser):
        self.browser, self.failures = browser, 0

    def claim(self, claim, holds, detail=""):
        self.failures += not holds
        print(f"{'ok' if holds else 'FAILED':8}{claim}{': ' if detail else ''}{detail}", flush=True)

    def data(self):
        """What the page says that it has drawn, after its next frame."""
        time.sleep(0.2)
        return self.browser.run("return {...document.documentElement.dataset}")

    def seek(self, share):
        self.browser.run(
            """
            const slider = document.querySelector("[name=time]");
            slider.value = arguments[0];
            slider.dispatchEvent(new Event("input", { bubbles: true }));
            """,
            share,
        )
        return self.data()

    def press(self, key):
        canvas = self.browser.call("POST", "/element", {"using": "css selector", "value": "canvas"})
        self.browser.call("POST", f"/element/{list(canvas.values())[0]}/value", {"text": key})
        return self.data()

    def drag(self, across, down):
        canvas = self.browser.call("POST", "/element", {"using": "css selector", "value": "canvas"})
        moves = [
            {"type": "pointerMove", "origin": canvas, "x": 0, "y": 0},
            {"type": "pointerDown", "button": 0},
            {"type": "pointerMove", "origin": canvas, "x": across, "y": down},
            {"type": "pointerUp", "button": 0},
        ]
        self.browser.call("POST", "/actions", {"actions": [{"type": "pointer", "id": "pointer", "actions": moves}]})
        return self.data()


def check(page, url):
    browser = page.browser
    browser.open(url)
    first = page.data()
    time.sleep(PLAYED)
    later = page.data()
    passed = float(later["time"]) - float(first["time"])
    page.claim("it plays when it is opened", first["status"] == "playing" and passed > 0.5, f"{passed:.2f} s passed")
    page.claim("it has six parts", first["parts"] == "6", first["parts"])
    resources = browser.run("return performance.getEntriesByType('resource').map(entry => entry.name)")
    page.claim("it loads nothing", resources == [], f"{resources}")
    title = browser.run("return [document.title, document.querySelector('h1').textContent, document.querySelectorAll('b').length]")
    page.claim("names are text", title == ['<b> & "c"', '<b> & "c"', 0], f"{title}")
    names = browser.run("return [...document.querySelectorAll('.names li')].map(item => item.textContent)")
    page.claim("all parts are named", names == ["</script><b>book", "ball", "point", "rod", "arrow", "frame"], f"{names}")

    ink = browser.run(INK)
    page.claim("the picture is drawn", ink > LEAST_INK, f"{ink:.1%} of its pixels")
    for share in [0.0, 0.325, 1.0]:
        data = page.seek(share)
        is_there = data["status"] == "paused" and abs(float(data["time"]) - 4 * share) < 1e-9
        page.claim(f"the slider moves to {4 * share} s", is_there and int(data["frame"]) == round(400 * share), f"{data}")
        # the point of the motion in closed form, from the middle and the radius that the page has
        angle = 2 * math.pi * share
        middle, radius = browser.run(
            "return [globe.slice(0, 3), globe[3]]"  # of the sphere of radius 1 about the origin
        )
        space = [1 + 2 * math.cos(angle), 2 * math.sin(angle), 0]
        shown = browser.run("return vectorsAt(parts[2], frameAt(now.share), 0)[0]")
        error = max(abs(m + radius * x - s) for m, x, s in zip(middle, space, shown))
        page.claim("the point is where it should be", error < 2e-4, f"{error:.1e} of the picture")
        # seen from above nothing covers the point
        browser.run("view.elevation = Math.PI / 2; refresh()")
        page.data()
        colour = browser.run(PLACE, *shown)
        wanted = browser.run("return [...palette()[2], 255]")
        page.claim("its pixel has its colour", colour == wanted, f"{colour}")
        browser.run("document.querySelector('[name=view]').click()")

    before = page.data()
    after = page.drag(60, 20)
    turned = float(before["azimuth"]) - float(after["azimuth"]), float(after["elevation"]) - float(before["elevation"])
    page.claim("the pointer turns the picture", turned[0] > 0.3 and turned[1] > 0.1, f"by {turned[0]:.2f} and {turned[1]:.2f}")
    zoomed = float(page.press("+")["zoom"])
    page.claim("a key zooms", zoomed > 1.1, f"{zoomed}")
    left = float(page.press("\ue012")["azimuth"])
    page.claim("an arrow turns", left > float(after["azimuth"]), f"{left}")
    playing = page.press(" ")
    paused = page.press(" ")
    states = playing["status"], paused["status"]
    page.claim("space plays and pauses", states == ("playing", "paused"), f"{states}")
    focus = browser.run("return [...document.querySelectorAll('canvas, button, input, select')].every(e => e.tabIndex >= 0)")
    page.claim("the keyboard reaches all controls", focus)

    browser.open("about:blank")
    browser.open(url + "#t=2.5")
    data = page.data()
    page.claim("a link opens a time", data["status"] == "paused" and abs(float(data["time"]) - 2.5) < 1e-9, f"{data['time']}")
    errors = browser.errors()
    page.claim("the console has no error", not errors, "; ".join(errors))


def take_pictures(page, folder):
    for theme in ["light", "dark"]:
        features = [{"name": "prefers-color-scheme", "value": theme}]
        page.browser.call("POST", "/goog/cdp/execute", {"cmd": "Emulation.setEmulatedMedia", "params": {"features": features}})
        page.seek(0.7)
        folder.joinpath(f"motion_{theme}.png").write_bytes(page.browser.picture())


def main(file, folder=None):
    driver = subprocess.Popen(["chromedriver", "--port=0"], stdout=subprocess.PIPE, text=True)
    try:
        browser = browser_of_live_pages()(driver)
        page = Page(browser)
        check(page, pathlib.Path(file).resolve().as_uri())
        if folder:
            take_pictures(page, pathlib.Path(folder))
        browser.close()
    finally:
        driver.terminate()
        driver.wait()
    print(f"{page.failures} checks of the page failed" if page.failures else "all checks of the page passed")
    return page.failures != 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
