"""Tries the live pages of a built book in headless Chromium: check.py BOOK [PICTURES]

docs/book/check runs it. With a folder PICTURES it writes a picture of each page there, in a light and in a dark theme.
"""

import base64
import functools
import http.server
import json
import pathlib
import re
import subprocess
import sys
import threading
import time
import urllib.error
import urllib.request

# seconds that a page has for an answer
PATIENCE = 120
# steps that the button of a page makes
JUMP = 100_000
# a picture has at least this share of its pixels drawn
LEAST_INK = 0.02

FLAGS = [
    "--headless=new",
    # the pages are those of this repository, and a container has no rights for a sandbox
    "--no-sandbox",
    "--disable-dev-shm-usage",
    "--disable-gpu",
    "--window-size=1200,1500",
    # the pages work without a network
    "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
]


class Browser:
    """A session of ChromeDriver, a process that runs already."""

    def __init__(self, driver):
        port = next(found[1] for line in driver.stdout if (found := re.search(r"successfully on port (\d+)", line)))
        self.url = f"http://127.0.0.1:{port}/session"
        always = {"goog:chromeOptions": {"args": FLAGS}, "goog:loggingPrefs": {"browser": "ALL"}}
        self.url += "/" + self.call("POST", "", {"capabilities": {"alwaysMatch": always}})["sessionId"]

    def call(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.url + path, data, {"Content-Type": "application/json"}, method=method)
        try:
            with urllib.request.urlopen(request, timeout=PATIENCE) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(json.load(error)["value"]["message"]) from error

    def open(self, url):
        self.call("POST", "/url", {"url": url})

    def run(self, script, *arguments):
        return self.call("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def picture(self):
        return base64.b64decode(self.call("GET", "/screenshot"))

    def errors(self):
        """Errors in the console since the last call. Other servers cannot be reached, so their errors do not count."""
        entries = self.call("POST", "/se/log", {"type": "browser"})
        severe = [entry["message"] for entry in entries if entry["level"] == "SEVERE"]
        return [message for message in severe if not re.match(r"https?://(?!127\.0\.0\.1)", message)]

    def close(self):
        self.call("DELETE", "")


class Files(http.server.SimpleHTTPRequestHandler):
    """Serves a folder, and prints only errors."""

    def log_request(self, *_):
        pass


class Page:
    """A live page with the results of its checks."""

    def __init__(self, browser, origin, name):
        self.browser, self.name, self.failures = browser, name, 0
        browser.open(f"{origin}/live/{name}.html")
        self.wait("it runs", lambda data: data.get("status") == "running" and float(data["steps"]) > 0)

    def data(self):
        return self.browser.run("return {...document.querySelector('.live').dataset}")

    def message(self):
        return self.browser.run("return document.querySelector('.live .message').textContent")

    def click(self, button):
        self.browser.run("document.querySelector(`.live button[name=${arguments[0]}]`).click()", button)

    def picture(self):
        return self.browser.run("return document.querySelector('.live .scene').toDataURL()")

    def drag(self):
        """Moves the pointer over the picture with its button down."""
        self.browser.run("document.querySelector('.live .scene').scrollIntoView()")
        scene = self.browser.call("POST", "/element", {"using": "css selector", "value": ".live .scene"})
        moves = [
            {"type": "pointerMove", "origin": scene, "x": 0, "y": 0},
            {"type": "pointerDown", "button": 0},
            {"type": "pointerMove", "origin": scene, "x": 60, "y": 20},
            {"type": "pointerUp", "button": 0},
        ]
        self.browser.call("POST", "/actions", {"actions": [{"type": "pointer", "id": "pointer", "actions": moves}]})

    def slide(self, name, value):
        """Moves a slider to the value that its label shows."""
        found = self.browser.run(
            """
            const [name, value] = arguments;
            const input = document.querySelector(`.live input[name=${name}]`);
            for (let place = Number(input.min); place <= Number(input.max); place += Number(input.step)) {
                input.value = place;
                input.dispatchEvent(new Event("input", { bubbles: true }));
                if (parseFloat(input.getAttribute("aria-valuetext")) === value) {
                    return true;
                }
            }
            return false;
            """,
            name,
            value,
        )
        self.claim(f"{name} can be {value}", found)

    def ink(self, canvas):
        """The share of the pixels of a canvas that are not transparent."""
        return self.browser.run(
            """
            const canvas = document.querySelector(`.live .${arguments[0]}`);
            const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
            let drawn = 0;
            for (let i = 3; i < data.length; i += 4) {
                drawn += data[i] > 0;
            }
            return drawn / (canvas.width * canvas.height);
            """,
            canvas,
        )

    def wait(self, claim, holds):
        """Waits until the data attributes of the page are as they should be."""
        end = time.monotonic() + PATIENCE
        while not (is_so := holds(data := self.data())) and time.monotonic() < end:
            time.sleep(0.05)
        self.claim(claim, is_so, "" if is_so else f"{data}")
        return data

    def claim(self, claim, holds, detail=""):
        self.failures += not holds
        print(f"{'ok' if holds else 'FAILED':8}{self.name:10}{claim}{detail and ': '}{detail}", flush=True)

    def energy_error(self, **sliders):
        """The largest error of the energy in many steps from the start, J. The momentum has to stay."""
        for name, value in sliders.items():
            self.slide(name, value)
        self.click("restart")
        # the attributes are those of the last frame, which may be of the motion before
        self.wait("it starts again", lambda data: float(data["steps"]) == 0)
        self.click("jump")
        data = self.wait(f"{JUMP} steps", lambda data: float(data["steps"]) == JUMP)
        energy, momentum = float(data["energyError"]), float(data["momentumError"])
        self.claim("the conserved momentum stays", momentum < 1e-11, f"its largest error is {momentum:.1e} kg·m²/s")
        return energy

    def claim_refusal(self, text, **sliders):
        for name, value in sliders.items():
            self.slide(name, value)
        self.click("jump")
        self.wait("it says that it cannot go on", lambda data: data["status"] == "refused")
        self.claim("it says why", text in self.message(), self.message())


def check_top(page):
    second = page.energy_error(step_size=0.02)
    page.claim("order 2, steps of 0.02 s", second < 1e-3, f"energy error {second:.1e} J")
    half = page.energy_error(step_size=0.01)
    page.claim("order 2, half the step size: about a quarter", 3.8 < second / half < 4.2, f"energy error {half:.1e} J")
    fourth = page.energy_error(step_size=0.02, order=4)
    page.claim("order 4: a thousandth", fourth < second / 1000, f"energy error {fourth:.1e} J")
    sixth = page.energy_error(order=6)
    page.claim("order 6: less again", sixth < fourth / 100, f"energy error {sixth:.1e} J")
    page.claim_refusal("too long", step_size=0.32, order=2)


def check_body(page):
    for step_size in [0.02, 0.32]:
        error = page.energy_error(step_size=step_size)
        page.claim(f"steps of {step_size} s", error < 1e-11, f"energy error {error:.1e} J")
    page.claim_refusal("too long", step_size=0.64)
    page.claim_refusal("No body", third=3.5)


def check_pendulum(page):
    error = page.energy_error(step_size=0.02)
    page.claim("steps of 0.02 s", error < 0.1, f"energy error {error:.1e} J")
    half = page.energy_error(step_size=0.01)
    page.claim("half the step size: about a quarter", 3.8 < error / half < 4.2, f"energy error {half:.1e} J")
    page.claim_refusal("too long", step_size=0.32, length=0.25)


def check(page, check_scene):
    ink = page.ink("scene"), page.ink("chart")
    page.claim("picture and chart are drawn", min(ink) > LEAST_INK, f"{ink[0]:.1%} and {ink[1]:.1%} of their pixels")

    page.click("pause")
    paused = page.wait("it pauses", lambda data: data["status"] == "paused")
    time.sleep(0.3)
    page.claim("it makes no steps in a pause", page.data()["steps"] == paused["steps"])

    before = page.picture()
    page.drag()
    time.sleep(0.3)
    page.claim("the pointer turns the picture", page.picture() != before)

    check_scene(page)

    page.click("reset")
    page.wait("it can be reset", lambda data: data["status"] == "paused" and float(data["steps"]) == 0)
    page.click("pause")
    page.wait("it goes on", lambda data: data["status"] == "running" and float(data["steps"]) > 0)
    errors = page.browser.errors()
    page.claim("the console has no error", not errors, "; ".join(errors))


def check_print(browser, origin, scenes):
    """Checks the page for printing, which has all chapters, and returns the number of failures."""
    browser.open(f"{origin}/print.html")
    end = time.monotonic() + PATIENCE
    while browser.run("return document.readyState") != "complete" and time.monotonic() < end:
        time.sleep(0.05)
    elements = browser.run("return [...document.querySelectorAll('.live')].map(element => element.childElementCount)")
    # the page waits for MathJax before it prints, and the network has it
    errors = [error for error in browser.errors() if "MathJax is not defined" not in error]
    claims = [
        ("each live page has its sentence", elements == [0] * scenes, f"{elements}"),
        ("the console has no error", not errors, "; ".join(errors)),
    ]
    for claim, holds, detail in claims:
        print(f"{'ok' if holds else 'FAILED':8}{'print':10}{claim}{'' if holds else ': ' + detail}", flush=True)
    return sum(not holds for _, holds, _ in claims)


def take_pictures(page, folder):
    for theme in ["light", "navy"]:
        page.browser.run("localStorage.setItem('mdbook-theme', arguments[0]); location.reload()", theme)
        page.wait(f"runs in the theme {theme}", lambda data: float(data.get("steps", 0)) > 100)
        folder.joinpath(f"{page.name}_{theme}.png").write_bytes(page.browser.picture())


def main(book, folder=None):
    handler = functools.partial(Files, directory=book)
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    origin = f"http://127.0.0.1:{server.server_port}"
    driver = subprocess.Popen(["chromedriver", "--port=0"], stdout=subprocess.PIPE, text=True)
    try:
        browser = Browser(driver)
        failures = 0
        scenes = [("top", check_top), ("body", check_body), ("pendulum", check_pendulum)]
        for name, check_scene in scenes:
            page = Page(browser, origin, name)
            if folder:
                take_pictures(page, pathlib.Path(folder))
            check(page, check_scene)
            failures += page.failures
        failures += check_print(browser, origin, len(scenes))
        browser.close()
    finally:
        driver.terminate()
        driver.wait()
        server.shutdown()
    print(f"{failures} checks of the live pages failed" if failures else "all checks of the live pages passed")
    return failures != 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
