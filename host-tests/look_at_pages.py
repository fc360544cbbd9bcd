#!/usr/bin/env python3
"""Looks at a page of every kind as a browser shows it: wide and on a phone, light, dark and on paper.

    look_at_pages.py MERIDIAN FOLDER

draws the pages of MERIDIAN, the program, into FOLDER, opens each in Chromium, and holds it to what a reader needs:

- nothing is loaded beside the file, and the file is no larger than 500 KB;
- no script fails, and values show under the pointer, and on a phone after a touch;
- no text is smaller than 11 pixels, and none has less contrast to what it stands on than 4.5 (WCAG 2.2, 1.4.3);
- nothing is wider than the window, also where everything is unfolded;
- numbers beside an axis, and words in a figure, do not touch each other.

Pictures of every view stay in FOLDER. Needs Chromium and the package `playwright` (Apache-2.0), whose own browsers it does
not need. Exits with 1 where anything does not hold.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

from playwright.sync_api import sync_playwright

RECORDINGS = Path(__file__).parent / "data" / "recordings"
LARGEST = 500_000
WIDTHS = {"wide": (1280, 900), "phone": (390, 844)}
# A4 within margins of 10 mm, at 96 pixels an inch.
PAPER = {"width": 718, "height": 1047}
# The first of these that is there.
BROWSERS = ["chromium", "chromium-browser", "google-chrome"]


def recording(name):
    return str(RECORDINGS / f"{name}.csv.gz")


def commands(folder):
    """Name and arguments of a page of every kind."""
    inputs = str(folder / "inputs.jsonl")
    few = ["--runs", "3"]
    return {
        "run-stage": ["run", "stage"],
        "run-stage-degraded": ["run", "stage", "--fault", "gyro-silent-once"],
        "run-stage-refused": ["run", "stage", "--fault", "gyro-silent"],
        "run-stage-survey": ["run", "stage", "--survey", "600", "--seconds", "300"],
        "run-stage-sway": ["run", "stage", "--sway", "0.05"],
        "run-stage-sway-realign": ["run", "stage", "--sway", "0.05", "--realign"],
        "run-stage-sway-handover": ["run", "stage", "--sway", "0.05", "--handover", "213.7,0.16"],
        "run-two-frame": ["run", "two-frame"],
        "run-two-frame-handover": ["run", "two-frame", "--handover", "213.7,0.16"],
        "run-turntable": ["run", "turntable"],
        "run-turntable-met": ["run", "turntable", "--sensor", "met", "--speeds", "0.1,0.2"],
        "run-vehicle": ["run", "vehicle", "--hold", "1800", "--realign", "--record", inputs],
        "run-vehicle-refused": ["run", "vehicle", "--fault", "never-drives"],
        "run-spin": ["run", "spin"],
        "replay-inputs": ["replay", inputs],
        "replay-circle": ["replay", recording("stepwise-circle")],
        "replay-mems": ["replay", recording("stepwise-mems")],
        "replay-left-out": ["replay", recording("stepwise-nudged")],
        "replay-unknown-g": ["replay", recording("stepwise-unknown-g")],
        "replay-positions": ["replay", recording("positions-four-fog"), "--method", "positions"],
        "replay-rotating": ["replay", recording("rotating-gyro")],
        "replay-met": ["replay", recording("rotating-met-two-speeds")],
        "replay-drive": ["replay", recording("drive-fog-three-stops")],
        "replay-parked": ["replay", recording("parked-swaying")],
        "replay-vertical": ["replay", recording("imu-broad-06"), "--method", "vertical"],
        "replay-spin": ["replay", recording("spin-80rps-noisy")],
        "allan": ["allan", recording("static-gyro-1h")],
        "plan": ["plan", "--arw", "0.001", "--bias-instability", "0.007", "--latitude", "48", "--sigma", "0.05"],
        "campaign-sokolov": ["campaign", "sokolov", "--runs", "20"],
        "campaign-burov": ["campaign", "burov", "--runs", "20"],
        "campaign-rotating": ["campaign", "rotating", *few],
        "campaign-szymanowski": ["campaign", "szymanowski", *few],
        "campaign-spin": ["campaign", "spin", *few],
        "campaign-keep": ["campaign", "keep", *few],
        "campaign-instrument": ["campaign", "instrument", *few],
        "campaign-faults": ["campaign", "faults", "--platform", "spin"],
        "campaign-disturbed": ["campaign", "disturbed", "--runs", "2", "--class", "base-turn"],
    }


# What a view is asked for, in the page: complaints, one a line.
LOOK = r"""
() => {
  const wrong = [];
  const shown = (element) => {
    const box = element.getBoundingClientRect();
    const style = getComputedStyle(element);
    return box.width > 0 && box.height > 0 && style.visibility !== "hidden" && style.opacity !== "0";
  };
  const texts = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const parent = walker.currentNode.parentElement;
    if (walker.currentNode.data.trim() && !["SCRIPT", "STYLE"].includes(parent.tagName) && shown(parent)) {
      texts.push([parent, walker.currentNode.data.trim()]);
    }
  }
  const canvas = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
  const colour = (text) => {
    canvas.clearRect(0, 0, 1, 1);
    canvas.fillStyle = text;
    canvas.fillRect(0, 0, 1, 1);
    return [...canvas.getImageData(0, 0, 1, 1).data];
  };
  const over = (top, below) => top.slice(0, 3).map((c, i) => (c * top[3] + below[i] * (255 - top[3])) / 255).concat(255);
  const ground = (element) => {
    const layers = [];
    for (let at = element; at; at = at.parentElement) layers.push(colour(getComputedStyle(at).backgroundColor));
    return layers.reverse().reduce((below, top) => over(top, below), [255, 255, 255, 255]);
  };
  const luminance = ([r, g, b]) => {
    const linear = [r, g, b].map((c) => (c /= 255) <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
  };
  for (const [element, text] of texts) {
    const style = getComputedStyle(element);
    const scale = element.ownerSVGElement ? element.getScreenCTM().a : 1;
    const size = parseFloat(style.fontSize) * scale;
    if (size < 10.99) wrong.push(`text of ${size.toFixed(1)} px: ${text}`);
    const ink = colour(element.ownerSVGElement ? style.fill : style.color);
    const below = ground(element);
    const [a, b] = [over(ink, below), below].map(luminance);
    const contrast = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    if (contrast < 4.5) wrong.push(`contrast of ${contrast.toFixed(2)}: ${text}`);
  }
  const root = document.documentElement;
  if (root.scrollWidth > root.clientWidth) wrong.push(`${root.scrollWidth} px wide in ${root.clientWidth}`);
  for (const element of document.querySelectorAll("body *")) {
    const box = element.getBoundingClientRect();
    if (element.closest("svg, .area") || !shown(element) || element.closest(".wide")) continue;
    if (box.right > root.clientWidth + 1) wrong.push(`${element.tagName} ${element.className} ends at ${box.right.toFixed(0)} px`);
    if (getComputedStyle(element).overflowX.match(/auto|scroll/) && element.scrollWidth > element.clientWidth) {
      wrong.push(`${element.tagName} scrolls sideways`);
    }
  }
  for (const words of document.querySelectorAll(".x-labels, .y-labels, .area")) {
    const boxes = [...words.querySelectorAll("span:not(.wide)")].filter(shown).map((span) => [span.getBoundingClientRect(), span.textContent]);
    boxes.forEach(([a, one], index) => {
      for (const [b, other] of boxes.slice(index + 1)) {
        if (a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom) {
          wrong.push(`${one} and ${other} touch`);
        }
      }
    });
  }
  return [...new Set(wrong)];
}
"""


def pointed(page, is_touched):
    """Complaints about figures that show no value under the pointer, or after a touch."""
    point, how = (page.touchscreen.tap, "after a touch") if is_touched else (page.mouse.move, "under the pointer")
    wrong = []
    for index, area in enumerate(page.query_selector_all(".area")):
        area.scroll_into_view_if_needed()
        box = area.bounding_box()
        point(box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"])
        tips = page.query_selector_all(".tip")
        if len(tips) != 1 or not tips[0].inner_text().strip():
            wrong.append(f"figure {index + 1} shows no value {how}")
        if not is_touched:
            page.mouse.move(1, 1)
    return wrong


def looked_at(browser, file, folder):
    """Complaints about a page in all its views."""
    wrong = [f"{file.stat().st_size} bytes"] if file.stat().st_size > LARGEST else []
    for name, (width, height) in WIDTHS.items():
        for scheme in ["light", "dark"]:
            is_touched = name == "phone"
            size = {"width": width, "height": height}
            context = browser.new_context(viewport=size, color_scheme=scheme, has_touch=is_touched)
            page = context.new_page()
            page.on("request", lambda asked: asked.url == file.as_uri() or wrong.append(f"loads {asked.url}"))
            page.on("pageerror", lambda error: wrong.append(f"script: {error}"))
            page.on("console", lambda said: said.type == "error" and wrong.append(f"console: {said.text}"))
            page.goto(file.as_uri())
            view = f"{name}, {scheme}"
            wrong += [f"{view}: {words}" for words in page.evaluate(LOOK)]
            page.screenshot(path=folder / f"{file.stem}-{name}-{scheme}.png", full_page=True)
            if scheme == "light":
                page.evaluate("() => document.querySelectorAll('details').forEach((it) => it.open = true)")
                wrong += [f"{view}: {words}" for words in pointed(page, is_touched)]
                wrong += [f"{view}, unfolded: {words}" for words in page.evaluate(LOOK)]
            if scheme == "dark" and name == "wide":
                page.emulate_media(media="print")
                page.set_viewport_size(PAPER)
                wrong += [f"print: {words}" for words in page.evaluate(LOOK)]
                page.pdf(path=folder / f"{file.stem}.pdf", format="A4", print_background=True)
            context.close()
    return wrong


def main():
    meridian, folder = sys.argv[1], Path(sys.argv[2]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    path = next(filter(None, map(shutil.which, BROWSERS)), None)
    if path is None:
        sys.exit(f"none of {', '.join(BROWSERS)} is installed")
    complaints, largest = 0, 0
    with sync_playwright() as playwright:
        # Root has no sandbox.
        sandbox = ["--no-sandbox"] if os.geteuid() == 0 else []
        browser = playwright.chromium.launch(executable_path=path, args=sandbox)
        for name, arguments in commands(folder).items():
            file = folder / f"{name}.html"
            subprocess.run([meridian, "--quiet", *arguments, "--report", file], stdout=subprocess.DEVNULL,
                           stderr=subprocess.DEVNULL, check=False)
            wrong = looked_at(browser, file, folder) if file.exists() else ["no page"]
            complaints += len(wrong)
            largest = max(largest, file.stat().st_size if file.exists() else 0)
            for words in wrong:
                print(f"{name}: {words}")
        browser.close()
    print(f"{len(commands(folder))} pages, the largest of {largest} bytes; complaints: {complaints}")
    sys.exit(complaints > 0)


main()
