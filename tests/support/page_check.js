// Ends a page under test: looks at it as a reader would, and leaves what it found as JSON in the
// element "check".
// Those that are alive, on the page or not.
function charts() {
  return typeof Chart === "undefined" ? [] : Object.values(Chart.instances);
}

// Every choice, every slider to its end, every object.
function useControls() {
  for (const select of document.querySelectorAll("select")) {
    for (let i = 0; i < select.options.length; ++i) {
      select.selectedIndex = i;
      select.dispatchEvent(new Event("change"));
    }
  }
  for (const range of document.querySelectorAll("input[type=range]")) {
    range.value = range.max;
    range.dispatchEvent(new Event("input"));
  }
  for (const box of document.querySelectorAll("input[type=checkbox]")) box.click();
  for (const button of document.querySelectorAll("button")) button.click();
}

function press(target, ...keys) {
  for (const key of keys) target.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true }));
}

// What each key changes on the map, the object that it leads to, and what a chart says of its points.
function useKeys(canvas) {
  const kKeys = ["ArrowLeft", "ArrowUp", "+", "-", "0"];
  const changed = kKeys.filter((key) => {
    const before = canvas.toDataURL();
    press(canvas, key);
    return canvas.toDataURL() !== before;
  });
  const names = ["n", "n", "p"].map((key) => {
    press(canvas, key);
    return document.querySelector("#picked strong").textContent;
  });
  const chart = document.querySelector("#stages canvas");
  press(chart, "ArrowRight", "ArrowRight");
  const focusable = [canvas, ...document.querySelectorAll(".chart canvas")].every(({ tabIndex }) => tabIndex === 0);
  return { changed, names, focusable, said: chart.closest("section").querySelector("output").textContent };
}

(async () => {
  const found = { errors: window.errorsOfPage, images: 0, broken_images: 0 };
  try {
    for (const image of document.querySelectorAll("svg image")) {
      const loaded = new Image();
      await new Promise((done) => {
        loaded.onload = () => { ++found.images; done(); };
        loaded.onerror = () => { ++found.broken_images; done(); };
        loaded.src = image.getAttribute("href");
      });
    }
    found.charts = charts().length;
    found.canvases = document.querySelectorAll(".chart canvas").length;
    found.strips = document.querySelectorAll("svg.strips").length;
    found.rows = document.querySelectorAll("tr[data-index]").length;
    const canvas = document.getElementById("map-canvas");
    if (canvas) {
      const view = JSON.parse(document.getElementById("data").textContent);
      found.variants = view.variants.length;
      const pixels = document.createElement("canvas");
      pixels.width = canvas.width;
      pixels.height = canvas.height;
      const context = pixels.getContext("2d");
      context.drawImage(canvas, 0, 0);
      const { data } = context.getImageData(0, 0, pixels.width, pixels.height);
      found.drawn_pixels = data.filter((value, i) => i % 4 === 3 && value > 0).length;
      // Clicks all over the map until an object is hit.
      const area = canvas.getBoundingClientRect();
      const picked = document.getElementById("picked");
      for (let i = 0; i < 400 && !picked.querySelector("dl"); ++i) {
        const at = { clientX: area.left + area.width * (i % 20 + 0.5) / 20,
          clientY: area.top + area.height * (Math.floor(i / 20) + 0.5) / 20, bubbles: true };
        canvas.dispatchEvent(new PointerEvent("pointerdown", at));
        canvas.dispatchEvent(new PointerEvent("pointerup", at));
      }
      found.picked = picked.textContent;
      found.keys = useKeys(canvas);
      useControls();
      await new Promise((done) => setTimeout(done, 500));  // charts are drawn with the next frames
      found.charts_after_use = charts().length;
      found.last_frame = document.querySelector("#map input[type=range]").nextElementSibling.textContent;
    }
  } catch (error) {
    found.errors.push(String(error));
  }
  document.body.append(Object.assign(document.createElement("pre"),
    { id: "check", textContent: "CHECK" + JSON.stringify(found) + "KCEHC" }));
})();
