// SPDX-License-Identifier: AGPL-3.0-or-later
// Strips as colours: a column for a frame, and the whole film at a glance.

const letters = "wroasx";
/** Which of several strips under one pixel is worth showing. */
const weight = { s: 0, w: 1, r: 2, o: 3, a: 4, x: 5 };
let colours = null;

function read() {
	const style = getComputedStyle(document.documentElement);
	const brush = document.createElement("canvas").getContext("2d");
	colours = {};
	for (const letter of letters) {
		brush.fillStyle = style.getPropertyValue(`--strip-${letter}`).trim();
		const hex = parseInt(brush.fillStyle.slice(1), 16);
		// As one 32-bit pixel, little-endian.
		colours[letter] = { text: brush.fillStyle, pixel: 0xff000000 | (hex & 0xff) << 16 | hex & 0xff00 | hex >> 16 };
	}
}

/** Calls `again` when the colours have changed. */
export function watchColours(again) {
	matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
		colours = null;
		again();
	});
}

/** A frame's strips from top to bottom, each as high as its rows. */
export function drawColumn(canvas, frame, job) {
	if (!colours)
		read();
	const ratio = devicePixelRatio, w = Math.max(1, Math.round(canvas.clientWidth * ratio)), h = Math.max(1, Math.round(canvas.clientHeight * ratio));
	const state = `${frame.join("")} ${w} ${h} ${colours.w.text}`;
	if (canvas.dataset.state === state)
		return;
	canvas.dataset.state = state;
	canvas.width = w;
	canvas.height = h;
	const brush = canvas.getContext("2d");
	const gap = h / frame.length > 5 ? Math.round(ratio) : 0;
	frame.forEach((letter, i) => {
		const y = Math.round(h * i * job.strip_rows / job.height), end = Math.round(h * Math.min((i + 1) * job.strip_rows, job.height) / job.height);
		brush.fillStyle = colours[letter].text;
		brush.fillRect(0, y, w, Math.max(1, end - y - gap));
	});
}

/** The film: a column a frame (or several frames), strips from top to bottom. */
export function drawOverview(canvas, model) {
	if (!colours)
		read();
	const job = model.chosen, per = job.strips_per_frame;
	const columns = Math.min(job.frames, 2048), rows = Math.min(per, 128);
	const worst = new Uint8Array(columns * rows);
	const order = Object.keys(weight);
	for (let i = 0; i < model.strips.length; ++i) {
		const x = Math.floor(Math.floor(i / per) * columns / job.frames), y = Math.floor(i % per * rows / per);
		const value = weight[model.strips[i]] + 1;
		if (value > worst[y * columns + x])
			worst[y * columns + x] = value;
	}
	canvas.width = columns;
	canvas.height = rows;
	const brush = canvas.getContext("2d"), image = brush.createImageData(columns, rows), pixels = new Uint32Array(image.data.buffer);
	for (let i = 0; i < worst.length; ++i)
		pixels[i] = worst[i] ? colours[order[worst[i] - 1]].pixel : 0;
	brush.putImageData(image, 0, 0);
	canvas.setAttribute("aria-label", `The film: ${job.frames_done} of ${job.frames} frames done`);
}
