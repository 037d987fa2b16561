// The element of a live page names its scene, with a script and a style sheet next to the page.
// The page for printing has all chapters at once: the sentences in their elements stay.
const live = document.querySelectorAll("[data-scene]");
if (live.length === 1) {
    const file = name => new URL(name, document.baseURI).href;
    const style = document.createElement("link");
    style.rel = "stylesheet";
    style.href = file("live.css");
    document.head.append(style);
    import(file(`${live[0].dataset.scene}.js`));
}
