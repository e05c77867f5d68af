"""A headless Chromium, driven over WebDriver by the standard library alone."""

import base64
import http.client
import json
import shutil
import socket
import subprocess
import tempfile
import time

ELEMENT = "element-6066-11e4-a52e-4f735466cecf"


def wait_until(claim, seconds, what):
    """Returns what the claim came to; fails by name when it has not come true in time."""
    end = time.monotonic() + seconds
    while True:
        value = claim()
        if value:
            return value
        if time.monotonic() > end:
            raise AssertionError(f"not within {seconds} s: {what}")
        time.sleep(0.02)


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Browser:
    def __init__(self, width=1280, height=1600, dark=False):
        self._folder = tempfile.mkdtemp(prefix="hitchview-browser-")
        self._port = free_port()
        self._driver = subprocess.Popen(
            ["chromedriver", f"--port={self._port}"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self._session = None
        try:
            wait_until(self._is_ready, 60, "chromedriver answers")
            self._session = self._call("POST", "/session", {"capabilities": {"alwaysMatch": {
                "goog:loggingPrefs": {"browser": "ALL"},
                "goog:chromeOptions": {"binary": shutil.which("chromium"), "args": [
                    "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run",
                    "--disable-background-networking", "--disable-component-update", "--disable-sync",
                    "--disable-dev-shm-usage", "--hide-scrollbars", f"--user-data-dir={self._folder}",
                    f"--window-size={width},{height}"] + (["--force-dark-mode"] if dark else [])}}}})["sessionId"]
            self.command("POST", "/window/rect", {"width": width, "height": height})
            self._call("POST", f"/session/{self._session}/goog/cdp/execute", {
                "cmd": "Emulation.setEmulatedMedia", "params": {"features": [
                    {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]}})
        except BaseException:
            self.close()
            raise

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        if self._session:
            self._call("DELETE", f"/session/{self._session}")
        self._driver.terminate()
        self._driver.wait()
        shutil.rmtree(self._folder, ignore_errors=True)

    def open(self, url):
        self.command("POST", "/url", {"url": url})

    def run(self, script, *arguments):
        """What a function body returns in the page."""
        return self.command("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def click(self, selector):
        found = self.command("POST", "/element", {"using": "css selector", "value": selector})
        self.command("POST", f"/element/{found[ELEMENT]}/click", {})

    def screenshot(self, file):
        with open(file, "wb") as out:
            out.write(base64.b64decode(self.command("GET", "/screenshot")))

    def complaints(self):
        """What the browser wrote to its console, worst kinds only."""
        log = self.command("POST", "/se/log", {"type": "browser"})
        return [entry["message"] for entry in log if entry["level"] == "SEVERE"]

    def command(self, method, path, body=None):
        return self._call(method, f"/session/{self._session}{path}", body)

    def _is_ready(self):
        try:
            return self._call("GET", "/status")["ready"]
        except OSError:
            return False

    def _call(self, method, path, body=None):
        line = http.client.HTTPConnection("127.0.0.1", self._port, timeout=120)
        line.request(method, path, None if body is None else json.dumps(body))
        answer = line.getresponse()
        value = json.loads(answer.read())["value"]
        line.close()
        if answer.status != 200:
            raise AssertionError(f"{method} {path}: {value.get('error')}: {value.get('message')}")
        return value
