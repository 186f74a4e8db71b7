// SPDX-License-Identifier: AGPL-3.0-or-later
// Words and numbers for people, and elements that hold them. What comes from scenes, workers and logs becomes text nodes, never markup.

/** An element with attributes (null and false leave one out) and children: nodes, or anything else as text. */
export function el(tag, attributes = {}, ...children) {
	const e = document.createElement(tag);
	for (const [name, value] of Object.entries(attributes))
		if (value !== null && value !== false)
			e.setAttribute(name, value === true ? "" : value);
	e.append(...children.map(c => (c instanceof Node ? c : String(c))));
	return e;
}

export const byId = id => document.getElementById(id);

/** Sets an element's text if it is another, so that selections and screen readers are left in peace. */
export function say(element, text) {
	if (element.textContent !== String(text))
		element.textContent = text;
}

/** 75 as "1:15 min", 4000 as "1:06 h", 200000 as "2 d 7 h". */
export function duration(seconds) {
	const s = Math.max(0, Math.round(seconds));
	const two = n => String(n).padStart(2, "0");
	if (s < 60)
		return `${s} s`;
	if (s < 3600)
		return `${Math.floor(s / 60)}:${two(s % 60)} min`;
	if (s < 172800)
		return `${Math.floor(s / 3600)}:${two(Math.floor(s / 60) % 60)} h`;
	return `${Math.floor(s / 86400)} d ${Math.floor(s / 3600) % 24} h`;
}

/** Seconds since 1970 as a time of today, or a date and a time. */
export function moment(seconds) {
	const date = new Date(1000 * seconds);
	const time = date.toLocaleTimeString([], { hour: "2-digit", minute: "2-digit" });
	return date.toDateString() === new Date().toDateString() ? time : `${date.toLocaleDateString([], { day: "numeric", month: "short" })} ${time}`;
}

/** With three digits or so. */
export function rate(number) {
	return number >= 100 ? String(Math.round(number)) : number >= 10 ? number.toFixed(1) : number.toFixed(2);
}

export const count = number => number.toLocaleString();
export const plural = (number, one, many = `${one}s`) => `${count(number)} ${number === 1 ? one : many}`;

/**
 * Makes a parent's children those of `items`, in order: an element is made once per key and then brought up to date, so that what has the focus keeps it.
 */
export function keyed(parent, items, key, make, update) {
	const known = parent.known ??= new Map();
	const wanted = new Set(items.map(key));
	for (const [k, element] of known)
		if (!wanted.has(k)) {
			element.remove();
			known.delete(k);
		}
	let before = null;
	for (const item of items) {
		const k = key(item);
		if (!known.has(k))
			known.set(k, make(item));
		const element = known.get(k);
		const place = before ? before.nextSibling : parent.firstChild;
		if (place !== element)
			parent.insertBefore(element, place);
		update(element, item);
		before = element;
	}
}
