"""The compiler of clebsch, in Rust."""

VERSION: str

class Declaration:
    name: str
    fields: list[tuple[str, str]]
    generics: list[tuple[str, bool]]
    methods: list[str]

Read = dict[str, object]
Mistake = dict[str, object]

def check(text: str) -> tuple[Read | None, list[Mistake]]: ...
def latex(text: str) -> tuple[str | None, list[Mistake]]: ...
