"use strict";
// A chart is drawn when it comes near the window: there can be hundreds, and those in a closed fold have no width.
const near = new IntersectionObserver((entries) => {
  for (const { target, isIntersecting } of entries) {
    if (!isIntersecting) continue;
    near.unobserve(target);
    const specification = JSON.parse(target.nextElementSibling.textContent);
    vegaEmbed(target, specification, { actions: false, renderer: "svg", tooltip: { theme: "custom" } })
      .catch((error) => { target.textContent = `This chart could not be drawn: ${error}`; console.error(error); });
  }
}, { rootMargin: "1000px" });
for (const chart of document.querySelectorAll(".chart")) near.observe(chart);
